"use strict";
// Opens the report in frames of several widths and writes what is wrong into #result.
(async () => {
  const faults = [];
  const expect = (fact, text) => { if (!fact) faults.push(text); };
  const opened = (width) => new Promise((resolve) => {
    const frame = document.createElement("iframe");
    frame.style.cssText = `width:${width}px;height:900px;border:0`;
    frame.onload = () => resolve(frame.contentDocument);
    frame.srcdoc = report;
    document.body.append(frame);
  });
  const meets = (a, b) => a.left < b.right - 0.5 && b.left < a.right - 0.5 && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5;

  const layout = (doc, width) => {
    const root = doc.documentElement;
    for (const section of ["memory", "scenes", "ratio", "errors"]) {
      expect(doc.querySelector(`#${section} svg text`), `${width}: no chart in ${section}`);
    }
    expect(root.scrollWidth <= width, `${width}: the page is ${root.scrollWidth} wide`);
    for (const svg of doc.querySelectorAll("svg")) {
      const name = `${width}: ${svg.getAttribute("aria-label")}`;
      const room = svg.getBoundingClientRect();
      const scale = room.width / svg.viewBox.baseVal.width;
      expect(scale > 0.85, `${name}: shrunk to ${scale}`);
      const texts = [...svg.querySelectorAll("text")].map((text) => {
        // The box of a line of text is higher than its letters.
        const { left, right, top, bottom } = text.getBoundingClientRect();
        return { text: text.textContent, left, right, top: top + 2 * scale, bottom: bottom - 2 * scale };
      });
      texts.forEach((a, i) => {
        expect(a.left >= room.left - 1 && a.right <= room.right + 1 && a.top >= room.top - 1 && a.bottom <= room.bottom + 1,
          `${name}: "${a.text}" leaves the drawing`);
        for (const b of texts.slice(0, i)) expect(!meets(a, b), `${name}: "${a.text}" over "${b.text}"`);
      });
    }
    for (const node of doc.querySelectorAll("h1,h2,h3,p,li,summary,figcaption,dd,dt,td,th,label,pre")) {
      const cut = node.clientWidth > 0 && node.scrollWidth > node.clientWidth + 1;
      expect(!cut, `${width}: cut: ${node.tagName} ${node.textContent.slice(0, 60)}`);
    }
  };

  const column = (table, name) => [...table.tHead.rows[0].cells].findIndex((head) => head.textContent === name);
  const visible = (table) => [...table.tBodies[0].rows].filter((row) => row.offsetParent !== null);

  const tables = (doc) => {
    const table = doc.getElementById("cells");
    const at = column(table, "time per ray");
    const head = table.tHead.rows[0].cells[at];
    const figures = () => visible(table).map((row) => row.cells[at].dataset.v).filter((v) => v !== undefined).map(Number);
    const all = visible(table).length;
    head.querySelector("button").click();
    const up = figures();
    expect(up.length > 10 && up.every((v, i) => i === 0 || up[i - 1] <= v), "sorting upward");
    expect(head.getAttribute("aria-sort") === "ascending", "aria-sort");
    head.querySelector("button").click();
    const down = figures();
    expect(down.every((v, i) => i === 0 || down[i - 1] >= v) && down[0] > down[down.length - 1], "sorting downward");
    expect(visible(table).length === all, "sorting loses no row");

    const filters = doc.querySelector('.filters[data-for="cells"]');
    const search = filters.querySelector("input");
    search.value = "sponza EMBREE";
    search.dispatchEvent(new Event("input"));
    const found = visible(table);
    expect(found.length > 0 && found.length < all, `searching leaves ${found.length} of ${all}`);
    expect(found.every((row) => /sponza/.test(row.textContent) && /embree/.test(row.textContent)), "searching finds all words");
    expect(filters.querySelector("output").textContent === `${found.length} of ${all} rows`, "the number of rows is told");
    const choice = filters.querySelector("select");
    search.value = "";
    choice.value = "sponza";
    choice.dispatchEvent(new Event("change"));
    const chosen = visible(table);
    expect(chosen.length > 0 && chosen.every((row) => row.cells[choice.dataset.column].textContent === "sponza"), "choosing a scene");
    choice.value = "";
    choice.dispatchEvent(new Event("change"));
    expect(visible(table).length === all, "all rows come back");
  };

  const tooltip = (doc) => {
    const node = doc.querySelector("svg .tip");
    const shown = doc.getElementById("tooltip");
    expect(shown.hidden, "no tooltip at first");
    node.dispatchEvent(new doc.defaultView.PointerEvent("pointermove", { clientX: 50, clientY: 50 }));
    expect(!shown.hidden && /\d/.test(shown.textContent), "hovering shows figures");
    node.dispatchEvent(new doc.defaultView.PointerEvent("pointerleave"));
    expect(shown.hidden, "the tooltip goes away");
  };

  let done = false;
  try {
    for (const width of [1400, 760, 390]) {
      const doc = await opened(width);
      doc.querySelectorAll("details").forEach((details) => { details.open = true; });
      layout(doc, width);
      tables(doc);
      tooltip(doc);
      const asked = doc.defaultView.performance.getEntriesByType("resource").map((entry) => entry.name);
      expect(asked.every((name) => name.startsWith("data:")), `requests: ${asked}`);
    }
    done = true;
  } catch (error) {
    faults.push(String(error.stack));
  }
  document.getElementById("result").textContent = JSON.stringify({ done, faults: faults.slice(0, 40), count: faults.length });
})();
