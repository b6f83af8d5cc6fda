//! All cards as one HTML page: pictures inside, nothing asked of the network, no script.
//!
//! Links lead to files beside the page: the viewer's pages, animations, reports. Colours are those
//! of the viewer, light or dark as the reader's system is.

use std::io::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tpb_film::atomic_write;
use tpb_page::{THEME, escape};

use super::card::{Card, LeftOut, Picture};
use crate::error::Result;

const TEMPLATE: &str = include_str!("assets/gallery.html");
const STYLE: &str = include_str!("assets/gallery.css");

/// Writes the page, whole or not at all.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, cards: &[Card]) -> Result<()> {
    let text = page(cards);
    Ok(atomic_write(path, |file| file.write_all(text.as_bytes()))?)
}

/// The page as text.
pub fn page(cards: &[Card]) -> String {
    let entry = |card: &Card| format!("<a href=\"#{}\">{}</a>\n", card.name, escape(&card.title));
    let contents: String = cards.iter().map(entry).collect();
    let scenes: String = cards.iter().map(article).collect();
    TEMPLATE
        .replace("{{style}}", &format!("{THEME}{STYLE}"))
        .replace("{{contents}}", &contents)
        .replace("{{scenes}}", &scenes)
}

fn article(card: &Card) -> String {
    let name = &card.name;
    let figures: String = card.pictures.iter().map(figure).collect();
    let fact = |(name, value): &(&str, String)| {
        format!("<dt>{}</dt><dd>{}</dd>", escape(name), escape(value))
    };
    let facts: String = card.facts.iter().map(fact).collect();
    let link = |(text, file): &(&str, String)| {
        format!("<a href=\"{}\">{}</a>\n", escape(file), escape(text))
    };
    let links: String = card.links.iter().map(link).collect();
    let warning = |text: &String| format!("<p class=\"warning\">{}</p>\n", escape(text));
    let warnings: String = card.warnings.iter().map(warning).collect();
    format!(
        "<article id=\"{name}\" aria-labelledby=\"{name}-title\">\n\
         <h2 id=\"{name}-title\">{}</h2>\n<p class=\"text\">{}</p>\n\
         <div class=\"pictures\">\n{figures}</div>\n{warnings}\
         <div class=\"notes\">\n<dl>{facts}</dl>\n{}</div>\n\
         <p class=\"command\"><code>{}</code></p>\n<p class=\"links\">{links}</p>\n</article>\n",
        escape(&card.title),
        escape(&card.text),
        left_out(&card.left_out),
        escape(&card.command),
    )
}

fn figure(picture: &Picture) -> String {
    format!(
        "<figure><a href=\"{}\"><img src=\"data:image/png;base64,{}\" alt=\"{}\"></a>\
         <figcaption>{}</figcaption></figure>\n",
        escape(&picture.file),
        STANDARD.encode(&picture.png),
        escape(&picture.alt),
        escape(&picture.caption),
    )
}

fn left_out(items: &[LeftOut]) -> String {
    if items.is_empty() {
        return "<div><h3>The plan leaves out</h3><p>Nothing: this scene needs it all.</p></div>\n"
            .to_owned();
    }
    let line = |item: &LeftOut| {
        let class = if item.loses_light { " class=\"lost\"" } else { "" };
        format!("<li{class}><b>{}</b>: {}</li>\n", escape(&item.part), escape(&item.reason))
    };
    let lines: String = items.iter().map(line).collect();
    format!("<div><h3>The plan leaves out</h3>\n<ul>\n{lines}</ul></div>\n")
}
