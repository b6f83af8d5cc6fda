//! Floor 0: what our self-contained HTML pages share, whatever they show.
//!
//! A page is one file that opens from a disk and asks the network for nothing. Its template has
//! places `{{title}}`, `{{style}}`, `{{data}}`, `{{uplot}}` and `{{scripts}}`; [`document`] fills
//! them. Style and scripts of all pages come first ([`STYLES`], [`SCRIPTS`]: colours of both themes,
//! buttons, tables, cards; the state and who listens to it, numbers as text, elements, ticks, the
//! theme's button, the help on keys), those of the page follow. Scripts are one program: each file is a subject, and they are joined inside one
//! function, so that their names meet nobody else's.
//!
//! Data travel as JSON inside the page: [`json_element`] writes them so that no text of theirs can
//! end the element.
//!
//! Not handled: pages of several files, translations.

use serde::Serialize;

/// uPlot 1.6.32, MIT: `assets/vendor/SOURCE.md`.
pub const UPLOT_SCRIPT: &str = include_str!("../assets/vendor/uPlot.iife.min.js");

/// Its licence, which goes with every copy.
pub const UPLOT_LICENCE: &str = include_str!("../assets/vendor/uPlot-LICENSE");

/// The colours, dark and light, as custom properties of the root element: all that pages without
/// script need.
pub const THEME: &str = include_str!("../assets/css/theme.css");

/// Style sheets of all pages.
pub const STYLES: [&str; 4] = [
    include_str!("../assets/vendor/uPlot.min.css"),
    THEME,
    include_str!("../assets/css/base.css"),
    include_str!("../assets/css/parts.css"),
];

/// Scripts of all pages.
pub const SCRIPTS: [&str; 6] = [
    include_str!("../assets/js/basics.js"),
    include_str!("../assets/js/state.js"),
    include_str!("../assets/js/axes.js"),
    include_str!("../assets/js/theme.js"),
    include_str!("../assets/js/command.js"),
    include_str!("../assets/js/help.js"),
];

/// What makes a page out of a template.
#[derive(Clone, Copy, Debug)]
pub struct Document<'a> {
    /// HTML with the places.
    pub template: &'a str,
    /// Title, as plain text.
    pub title: &'a str,
    /// Style sheets of this page, after those of all.
    pub styles: &'a [&'a str],
    /// Elements that hold its data, such as those of [`json_element`].
    pub data: &'a str,
    /// Scripts of this page, after those of all.
    pub scripts: &'a [&'a str],
}

/// The page as text.
pub fn document(parts: &Document<'_>) -> String {
    let joined = |shared: &[&str], own: &[&str]| [shared.concat(), own.concat()].concat();
    let scripts = joined(&SCRIPTS, parts.scripts);
    fill(
        parts.template,
        &[
            ("title", &escape(parts.title)),
            ("style", &joined(&STYLES, parts.styles)),
            ("data", parts.data),
            ("uplot", &format!("/*\n{UPLOT_LICENCE}*/\n{UPLOT_SCRIPT}")),
            ("scripts", &format!("(() => {{\n\"use strict\";\n{scripts}}})();\n")),
        ],
    )
}

/// A text with its places `{{name}}` filled, in one sweep: what is filled in is not looked at
/// again. Places without a part stay empty.
pub fn fill(template: &str, parts: &[(&str, &str)]) -> String {
    let size: usize = parts.iter().map(|part| part.1.len()).sum();
    let mut out = String::with_capacity(template.len() + size);
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        out.push_str(before);
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        let part = parts.iter().find(|part| part.0 == name);
        out.push_str(part.map_or("", |part| part.1));
        rest = after;
    }
    out.push_str(rest);
    out
}

/// Plain text as HTML, inside an element or a quoted attribute.
pub fn escape(text: &str) -> String {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    escaped.replace('"', "&quot;").replace('\'', "&#39;")
}

/// A script element of this id that holds a value as JSON. The id is ours: letters and hyphens.
///
/// # Errors
/// If the value is none that JSON can hold.
pub fn json_element(id: &str, value: &impl Serialize) -> Result<String, serde_json::Error> {
    // The one character by which HTML could leave the element.
    let json = serde_json::to_string(value)?.replace('<', "\\u003c");
    Ok(format!("<script type=\"application/json\" id=\"{id}\">{json}</script>\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_filled_once() {
        let parts = [("a", "{{b}}"), ("b", "B")];
        assert_eq!(fill("1 {{a}} 2 {{b}} 3 {{c}} 4", &parts), "1 {{b}} 2 B 3  4");
        assert_eq!(fill("open {{a", &parts), "open {{b}}");
    }

    #[test]
    fn data_cannot_end_their_element() {
        let value = vec!["</script><b>", "<!--", "\u{2028}"];
        let element = json_element("data", &value).unwrap();
        let inner = element.strip_prefix("<script type=\"application/json\" id=\"data\">").unwrap();
        let inner = inner.strip_suffix("</script>\n").unwrap();
        assert!(!inner.contains('<'), "{inner}");
        assert_eq!(serde_json::from_str::<Vec<String>>(inner).unwrap(), value);
    }

    #[test]
    fn a_document_holds_everything_and_asks_for_nothing() {
        let text = document(&Document {
            template: "<title>{{title}}</title><style>{{style}}</style>{{data}}\
                       <script>{{uplot}}</script><script>{{scripts}}</script>",
            title: "A & \"b\" <c>",
            styles: &["own-style{}"],
            data: "DATA",
            scripts: &["ownScript();\n"],
        });
        assert!(text.contains("<title>A &amp; &quot;b&quot; &lt;c&gt;</title>"));
        let places =
            ["--page:", "own-style{}", "DATA", "var uPlot", "function element", "ownScript"];
        let found: Vec<_> = places.iter().map(|place| text.find(place)).collect();
        assert!(found.iter().all(Option::is_some) && found.is_sorted(), "{found:?}");
        for part in ["http://", "https://", "src=", "url("] {
            let ours = text.replace("https://github.com/leeoniya/uPlot", "");
            assert!(!ours.contains(part), "the page asks for nothing, but has {part}");
        }
    }
}
