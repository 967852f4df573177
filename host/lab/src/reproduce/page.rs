//! One paper's page: what it prints, what was measured here, the difference, the reason.

use super::plot::escaped;
use crate::tables::markdown::{Rows, line};
use std::fmt::Write;

/// One comparison.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// What is compared.
    pub what: String,
    /// The paper's number, or its trend in words.
    pub paper: String,
    /// What was measured here.
    pub ours: String,
    /// The difference.
    pub difference: String,
}

/// A table or figure of the paper.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Section {
    /// Its name in the marks of the book's tables; empty where the book shows none of it.
    pub id: &'static str,
    /// As the paper numbers it, and what it shows.
    pub title: String,
    /// What it was measured on.
    pub material: String,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// Why ours differs.
    pub reason: String,
    /// File names of its pictures, SVG or PNG.
    pub pictures: Vec<String>,
    /// A table of numbers: the first row is its head.
    pub table: Vec<Vec<String>>,
}

/// A paper's page.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Page {
    /// The paper.
    pub title: String,
    /// Command, commit, machine and time, each with its name.
    pub made_by: Vec<(&'static str, String)>,
    /// What is left out of this run, and why.
    pub left_out: Vec<String>,
    /// Tables and figures in the paper's order.
    pub sections: Vec<Section>,
}

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#111}\
table{border-collapse:collapse;margin:1em 0}th,td{border:1px solid #999;padding:.3em .6em;text-align:left;\
vertical-align:top}figure{margin:1em 0}img{max-width:100%}";

fn cells(tag: &str, texts: &[&str]) -> String {
    let cells: String = texts.iter().map(|text| format!("<{tag}>{}</{tag}>", prose(text))).collect();
    format!("<tr>{cells}</tr>\n")
}

/// `text` for HTML; what stands between backticks is code.
fn prose(text: &str) -> String {
    let text = escaped(text);
    let parts = text.split('`').enumerate();
    parts.map(|(index, part)| if index % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() }).collect()
}

impl Page {
    /// The page as HTML; pictures stand beside it.
    #[must_use]
    pub fn to_html(&self) -> String {
        let title = escaped(&self.title);
        let mut html = format!(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title><style>{STYLE}</style>\n\
             <h1>{title}</h1>\n<table>\n"
        );
        for (name, value) in &self.made_by {
            html.push_str(&cells("td", &[name, value]));
        }
        html.push_str("</table>\n");
        if !self.left_out.is_empty() {
            html.push_str("<h2>Left out of this run</h2><ul>\n");
            self.left_out.iter().for_each(|text| html.push_str(&format!("<li>{}</li>\n", prose(text))));
            html.push_str("</ul>\n");
        }
        self.sections.iter().for_each(|section| section.write(&mut html));
        html.push_str("</html>\n");
        html
    }
}

impl Page {
    /// The tables of the book by the names of their marks, for the paper `name`: how the page was
    /// made, and of each section with an id the comparisons and the numbers.
    #[must_use]
    pub fn tables(&self, name: &str) -> Vec<(String, Rows)> {
        let mut made = vec![line(self.made_by.iter().map(|(name, _)| *name))];
        made.push(line(self.made_by.iter().map(|(_, value)| value.clone())));
        let mut all = vec![(format!("reproduce-{name}-made"), made)];
        for section in self.sections.iter().filter(|section| !section.id.is_empty()) {
            let mut rows = vec![line(["", "paper", "ours", "difference"])];
            rows.extend(section.rows.iter().map(|row| line([&*row.what, &*row.paper, &*row.ours, &*row.difference])));
            all.push((format!("reproduce-{name}-{}", section.id), rows));
            all.push((format!("reproduce-{name}-{}-numbers", section.id), section.table.clone()));
        }
        all
    }
}

impl Section {
    fn write(&self, html: &mut String) {
        let _ = writeln!(html, "<h2>{}</h2><p>{}</p>", escaped(&self.title), prose(&self.material));
        if !self.rows.is_empty() {
            html.push_str("<table>\n");
            html.push_str(&cells("th", &["", "paper", "ours", "difference"]));
            for Row { what, paper, ours, difference } in &self.rows {
                html.push_str(&cells("td", &[what, paper, ours, difference]));
            }
            html.push_str("</table>\n");
        }
        if !self.reason.is_empty() {
            let _ = writeln!(html, "<p>Reason: {}</p>", prose(&self.reason));
        }
        if let Some((head, rows)) = self.table.split_first() {
            html.push_str("<table>\n");
            for (tag, row) in std::iter::once(("th", head)).chain(rows.iter().map(|row| ("td", row))) {
                html.push_str(&cells(tag, &row.iter().map(String::as_str).collect::<Vec<_>>()));
            }
            html.push_str("</table>\n");
        }
        for picture in &self.pictures {
            let name = escaped(picture);
            let _ = writeln!(html, "<figure><img src=\"{name}\" alt=\"{}: {name}\"></figure>", escaped(&self.title));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_holds_paper_ours_and_reason_and_says_what_is_left_out() {
        let row = Row { what: "sigma 1".into(), paper: "2.81".into(), ours: "0.35".into(), difference: "-2.46".into() };
        let section = Section {
            id: "table-1",
            title: "Table 1".into(),
            rows: vec![row],
            reason: "walks & not <swimmers>".into(),
            pictures: vec!["table_1.svg".into()],
            table: vec![vec!["a".into()], vec!["1".into()]],
            ..Section::default()
        };
        let page = Page {
            title: "cyclic".into(),
            left_out: vec!["seeds 6 to 10".into()],
            made_by: vec![("command", "`reproduce cyclic` <all>".into()), ("commit", "abc".into())],
            sections: vec![section],
        };
        let html = page.to_html();
        for part in [
            "<td>sigma 1</td><td>2.81</td><td>0.35</td><td>-2.46</td>",
            "walks &amp; not &lt;swimmers&gt;",
            "<img src=\"table_1.svg\"",
            "<li>seeds 6 to 10</li>",
            "<tr><th>a</th></tr>",
            "<td>commit</td><td>abc</td>",
            "<td><code>reproduce cyclic</code> &lt;all&gt;</td>",
        ] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
        let tables = page.tables("cyclic");
        let names: Vec<&str> = tables.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["reproduce-cyclic-made", "reproduce-cyclic-table-1", "reproduce-cyclic-table-1-numbers"]);
        assert_eq!(tables[0].1, [line(["command", "commit"]), line(["`reproduce cyclic` <all>", "abc"])]);
        assert_eq!(tables[1].1[1], line(["sigma 1", "2.81", "0.35", "-2.46"]));
    }
}
