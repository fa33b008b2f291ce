"use strict";
(() => {
  // Figures on hovering: titles become a tooltip of our own, and stay names for screen readers.
  const tooltip = document.getElementById("tooltip");
  const show = (node, x, y) => {
    tooltip.textContent = node.dataset.tip;
    tooltip.hidden = false;
    const box = tooltip.getBoundingClientRect();
    tooltip.style.left = Math.max(6, Math.min(x + 14, innerWidth - box.width - 6)) + "px";
    tooltip.style.top = (y + box.height + 24 > innerHeight ? y - box.height - 10 : y + 16) + "px";
  };
  const hide = () => { tooltip.hidden = true; };
  for (const node of document.querySelectorAll(".tip")) {
    const title = node.querySelector("title");
    if (!title) continue;
    node.dataset.tip = title.textContent;
    node.setAttribute("role", "img");
    node.setAttribute("aria-label", title.textContent);
    title.remove();
    node.addEventListener("pointermove", (e) => show(node, e.clientX, e.clientY));
    node.addEventListener("pointerleave", hide);
    node.addEventListener("focus", () => {
      const box = node.getBoundingClientRect();
      show(node, box.left, box.bottom);
    });
    node.addEventListener("blur", hide);
  }
  addEventListener("scroll", hide, { passive: true });

  // Sorting: by figure where a cell has one, else by text; empty cells last.
  const compare = (a, b, i, sign) => {
    const [x, y] = [a.cells[i], b.cells[i]];
    const empty = Number(x.textContent === "") - Number(y.textContent === "");
    if (empty) return empty;
    if ("v" in x.dataset && "v" in y.dataset) return sign * (x.dataset.v - y.dataset.v);
    return sign * x.textContent.localeCompare(y.textContent, "en", { numeric: true });
  };
  for (const table of document.querySelectorAll("table[id]")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, i) => head.querySelector("button")?.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const body = table.tBodies[0];
      body.append(...[...body.rows].sort((a, b) => compare(a, b, i, down ? -1 : 1)));
    }));
  }

  // Filters: every word of the search must be in the row, every choice must be met.
  for (const filters of document.querySelectorAll(".filters")) {
    const rows = [...document.getElementById(filters.dataset.for).tBodies[0].rows];
    const search = filters.querySelector("input");
    const choices = [...filters.querySelectorAll("select")];
    for (const choice of choices) {
      const values = new Set(rows.map((row) => row.cells[choice.dataset.column].textContent));
      const sorted = [...values].sort((a, b) => a.localeCompare(b, "en", { numeric: true }));
      choice.append(...sorted.map((value) => new Option(value)));
    }
    const apply = () => {
      const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        const fits = words.every((word) => text.includes(word))
          && choices.every((c) => c.value === "" || row.cells[c.dataset.column].textContent === c.value);
        row.hidden = !fits;
        shown += fits;
      }
      // What is longer stays off the paper.
      filters.nextElementSibling.classList.toggle("long", shown > 60);
      filters.querySelector("output").textContent =
        shown === rows.length ? `${shown} rows` : `${shown} of ${rows.length} rows`;
    };
    search.addEventListener("input", apply);
    choices.forEach((choice) => choice.addEventListener("change", apply));
  }
})();
