//! One file with styles, script, module and scene.

use crate::scene_pack::ScenePack;
use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use sinew::report::page::source_hash;

const HEAD: &str = include_str!("../assets/head.html");
const BODY: &str = include_str!("../assets/body.html");
const STYLES: [&str; 2] = [include_str!("../assets/theme.css"), include_str!("../assets/layout.css")];
/// Holds the licence of the face detector's model, which the page has inside.
const NOTICES: &str = include_str!("../../../../THIRD_PARTY_NOTICES.md");
/// Heading of that part.
const MODEL_HEADING: &str = "## The face detector's model";
/// The parts of the script, each after those that it calls.
const SCRIPTS: [&str; 13] = [
    include_str!("../assets/element.js"),
    include_str!("../assets/notice.js"),
    include_str!("../assets/size.js"),
    include_str!("../assets/tracker.js"),
    include_str!("../assets/recording.js"),
    include_str!("../assets/scene.js"),
    include_str!("../assets/video.js"),
    include_str!("../assets/overlay.js"),
    include_str!("../assets/timing.js"),
    include_str!("../assets/settings.js"),
    include_str!("../assets/pointer.js"),
    include_str!("../assets/app.js"),
    include_str!("../assets/main.js"),
];

/// What the script reads.
#[derive(Debug, Serialize)]
struct Data<'a> {
    /// The module in base64.
    module: String,
    scene: &'a ScenePack,
}

/// The page's text.
///
/// # Errors
/// None in practice: numbers that JSON cannot hold.
pub fn page(module: &[u8], scene: &ScenePack) -> Result<String> {
    let data = serde_json::to_string(&Data { module: STANDARD.encode(module), scene })?.replace('<', "\\u003c");
    let style = format!("\n{}", STYLES.concat());
    let script = format!("\n'use strict';\n(() => {{\n{}}})();\n", SCRIPTS.concat());
    let head = HEAD.replace("STYLE_HASH", &source_hash(&style)).replace("SCRIPT_HASH", &source_hash(&script));
    let notice = NOTICES.split_once(MODEL_HEADING).map(|(_, after)| after.split("\n## ").next().unwrap_or(after));
    let notice = notice.context("the notice of the face detector's model is missing")?.trim();
    Ok(format!(
        "{head}<!--\n{notice}\n-->\n<style>{style}</style>\n</head>\n{BODY}<script type=\"application/json\" id=\"data\">{data}</script>\n\
         <script>{script}</script>\n</body>\n</html>\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_no_address_and_may_connect_to_none() {
        for part in SCRIPTS.iter().chain(&STYLES).chain(&[HEAD, BODY]) {
            assert!(!part.contains("http:") && !part.contains("https:") && !part.contains("</script>"), "{part}");
            assert!(!["fetch(", "XMLHttpRequest", "WebSocket", "sendBeacon"].iter().any(|way| part.contains(way)));
        }
        assert!(HEAD.contains("default-src 'none'") && HEAD.contains("connect-src 'none'"));
    }

    #[test]
    fn only_the_pages_own_script_and_styles_count() {
        let scene = crate::builtin::BuiltinScene::new(0.0).unwrap();
        let page = page(b"module", &crate::scene_pack::packed(&scene).unwrap()).unwrap();
        assert!(page.contains("Redistributions in binary form must reproduce the above copyright notice"));
        assert_eq!(page.matches("-->").count(), 1, "the notice is a comment");
        assert!(!page.contains("unsafe-inline") && !page.contains("_HASH"));
        for (begin, end, kind) in [("<style>", "</style>", "style-src"), ("<script>", "</script>", "script-src")] {
            let (_, after) = page.split_once(begin).unwrap();
            let (text, _) = after.split_once(end).unwrap();
            assert!(page.contains(&format!("{kind} {}", source_hash(text))), "{kind}");
        }
    }
}
