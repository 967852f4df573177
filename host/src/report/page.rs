//! The page: one file with styles, script, data and pictures, which loads nothing.

use super::document::Document;
use super::pictures::{Block, block_name};
use crate::error::Result;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::io::Write;

/// What stands before the data; the policy lets the page ask for nothing from outside.
const HEAD: &str = include_str!("page/head.html");
const BODY: &str = include_str!("page/body.html");
const STYLES: [&str; 4] = [
    include_str!("page/theme.css"),
    include_str!("page/layout.css"),
    include_str!("page/plot.css"),
    include_str!("page/print.css"),
];
/// The parts of the script, each after those that it calls.
const SCRIPTS: [&str; 13] = [
    include_str!("page/element.js"),
    include_str!("page/table_data.js"),
    include_str!("page/axis.js"),
    include_str!("page/series_data.js"),
    include_str!("page/pointer.js"),
    include_str!("page/plot.js"),
    include_str!("page/bars.js"),
    include_str!("page/figure.js"),
    include_str!("page/player.js"),
    include_str!("page/table_view.js"),
    include_str!("page/summary.js"),
    include_str!("page/theme.js"),
    include_str!("page/main.js"),
];

/// Writes the page.
///
/// # Errors
/// What the writer refuses.
pub fn write_page(document: &Document, blocks: &[Block], writer: &mut dyn Write) -> Result<()> {
    let style = format!("\n{}", STYLES.concat());
    let script = format!("\n'use strict';\n(() => {{\n{}}})();\n", SCRIPTS.concat());
    let head = HEAD.replace("STYLE_HASH", &source_hash(&style)).replace("SCRIPT_HASH", &source_hash(&script));
    writeln!(writer, "{head}<style>{style}</style>\n</head>\n{BODY}")?;
    write_data("data", document, writer)?;
    for (index, block) in blocks.iter().enumerate() {
        write_data(&block_name(index), block, writer)?;
    }
    writeln!(writer, "<script>{script}</script>\n</body>\n</html>")?;
    Ok(())
}

/// What a content security policy calls this text: nothing else runs, whatever a run is named.
#[must_use]
pub fn source_hash(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)))
}

fn write_data(id: &str, data: &impl Serialize, writer: &mut dyn Write) -> Result<()> {
    let json = serde_json::to_string(data)?;
    writeln!(writer, "<script type=\"application/json\" id=\"{id}\">{}</script>", inert(&json))?;
    Ok(())
}

/// JSON of the same meaning in which nothing can end a script element or begin a comment.
fn inert(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::document::{FORMAT, Run};

    #[test]
    fn no_text_of_a_run_can_leave_its_script_element() {
        let evil = "</script><script>alert(1)</script><!--\u{2028}&quot;";
        let run = Run { name: evil.to_owned(), ..Run::default() };
        let document = Document { format: FORMAT, sinew_version: "0", runs: vec![run] };
        let mut page = Vec::new();
        write_page(&document, &[Block(vec![None])], &mut page).unwrap();
        let page = String::from_utf8(page).unwrap();
        assert!(!page.contains("alert(1)</script>") && !page.contains("<!--"));
        let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
        let back: serde_json::Value = serde_json::from_str(data).unwrap();
        assert_eq!(back["runs"][0]["name"], evil);
        assert_eq!(page.matches("<script").count(), 3);
        assert_eq!(page.matches("</script>").count(), 3);
    }

    #[test]
    fn the_policy_names_what_the_page_holds_and_nothing_else() {
        let document = Document { format: FORMAT, sinew_version: "0", runs: Vec::new() };
        let mut page = Vec::new();
        write_page(&document, &[], &mut page).unwrap();
        let page = String::from_utf8(page).unwrap();
        let between = |from: &str, to: &str| page.split(from).nth(1).unwrap().split(to).next().unwrap();
        let policy = between("Content-Security-Policy\" content=\"", "\"");
        for part in [between("<style>", "</style>"), between("<script>", "</script>")] {
            assert!(policy.contains(&source_hash(part)), "{policy}");
        }
        assert!(!policy.contains("unsafe") && policy.ends_with("base-uri 'none'; form-action 'none'"), "{policy}");
        // The hash of no text, as `openssl dgst -sha256 -binary | base64` gives it.
        assert_eq!(source_hash(""), "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
    }

    #[test]
    fn the_page_names_no_address() {
        for part in SCRIPTS.iter().chain(&STYLES).chain(&[HEAD, BODY]) {
            // The name of SVG's elements is an address that no browser loads.
            let rest = part.replace("http://www.w3.org/2000/svg", "");
            for sign in ["http:", "https:", "//cdn", "url(", "@import", "import(", "fetch(", "src=\""] {
                assert!(!rest.contains(sign), "{sign}");
            }
        }
    }
}
