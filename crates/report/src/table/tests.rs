//! One table in all its forms.

use super::*;

fn table() -> Table {
    let mut table = Table::new(["name".into(), figure("time per ray")]);
    table.push([Value::text("a|b <i>_x_</i>"), Value::figure(Some(12.5), |v| format!("{v} ns"))]);
    table.push([Value::code("`=1`|\n"), Value::figure(None, |v| v.to_string())]);
    table
}

#[test]
fn what_cells_hold_stays_text_in_markdown() {
    let text = table().markdown();
    assert_eq!(
        text,
        "| name | time per ray |\n| --- | ---: |\n| a\\|b &lt;i&gt;\\_x\\_&lt;/i&gt; | 12.5 ns |\n\
         | `` `=1`\\|  `` | – |\n"
    );
    assert_eq!(
        escape("small-10k a_b ~1 [x](y) \u{1b}[2J\nnext"),
        "small-10k a_b ~1 \\[x\\](y) \\\\u001b\\[2J next"
    );
    assert!(!escape("<!-- rayscale: end -->").contains("<!--"));
}

#[test]
fn columns_end_together_however_wide_their_letters_are() {
    let text = table().text();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "name            time per ray");
    assert_eq!(lines[1], "a|b <i>_x_</i>       12.5 ns");
    assert_eq!(lines[2], "`=1`|                      –");
}

#[test]
fn names_of_any_length_are_shown() {
    let mut table = Table::of_figures("name", ["n".repeat(70_000)]);
    table.push(["x".repeat(200_000), "1".to_owned()]);
    let text = table.text();
    assert!(text.lines().all(|line| line.chars().count() == 202), "{text}");
    assert!(text.contains('…'));
}

#[test]
fn nothing_commands_a_terminal() {
    let mut table = Table::new(["name"]);
    table.push(["\u{1b}]0;title\u{7}\u{9b}31m\r\u{202e}end"]);
    assert_eq!(table.text(), "name\n\\u001b]0;title\\u0007\\u009b31m\\u000d\\u202eend");
    assert_eq!(printable("bmssm\tµs\n"), "bmssm\tµs\n");
}

#[test]
fn spreadsheets_find_no_formula() {
    let mut table = Table::new(["text".into(), figure("figure")]);
    for text in ["=1+1", "+1", "-1", "@SUM(A1)", "\tx", "plain - text"] {
        table.push([Value::text(text), Value::figure(Some(-1.0), |_| String::new())]);
    }
    let mut out = Vec::new();
    table.csv(&mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    assert_eq!(text, "text,figure\n'=1+1,-1\n'+1,-1\n'-1,-1\n'@SUM(A1),-1\n'\tx,-1\nplain - text,-1\n");
}

#[test]
fn html_has_figures_to_sort_by_and_escapes() {
    let page = table().interactive(Interactive { id: "t", choices: &[0] }).into_string();
    assert!(page.contains("<td class=\"n\" data-v=\"12.5\">12.5 ns</td>"), "{page}");
    assert!(page.contains("a|b &lt;i&gt;_x_&lt;/i&gt;") && page.contains("<code>`=1`|\n</code>"), "{page}");
    assert!(table().html(|v| v < 13.0).into_string().contains("class=\"n best\""));
}
