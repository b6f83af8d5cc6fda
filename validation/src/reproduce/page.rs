//! Self-contained HTML pages: text, tables, pictures and charts inside one file, in the colours of
//! the comparison page, dark and light, for wide and narrow screens.
//!
//! A page stays below the budget of a viewer's page: where its pictures are too large for that, all
//! of them are shown smaller, by the same whole number, and the page says so.

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use tpb_film::atomic_write;
use tpb_page::escape;
use tpb_viewer::DEFAULT_BUDGET;

use super::picture::Picture;
use crate::error::{Result, ValidationError};

/// Pictures are shown this many times smaller at most.
const SMALLEST: usize = 64;
/// Longer cells of tables are sentences, longer heads words that may break.
const WORDS: usize = 48;
const HEAD: usize = 8;
/// Tables with more columns are small print: all of them are seen on a screen 1440 pixels wide.
const COLUMNS: usize = 10;

/// Layout; colours come from the theme.
const STYLE: &str = "
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 92rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.25rem; margin: 2rem 0 .5rem; }
p, li { max-width: 46rem; }
a { color: var(--accent); }
code { background: var(--field); padding: .1em .3em; border-radius: 4px; overflow-wrap: anywhere; }
.wide { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  padding: .6rem; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--muted); padding-bottom: .4rem; }
caption span { display: block; position: sticky; left: 0; max-width: min(60rem, calc(100vw - 3.4rem)); }
details { margin: .6rem 0; } summary { cursor: pointer; color: var(--muted); }
th, td { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
th.text, td.text { text-align: left; }
td.words { white-space: normal; min-width: 14rem; }
td.parts { white-space: normal; }
td.text:first-child { white-space: normal; min-width: 8rem; }
th.words { white-space: normal; } .whole { white-space: nowrap; }
table.dense { font-size: .85rem; } table.dense th, table.dense td { padding: .2rem .35rem; }
table.pictures th, table.pictures td { border: 0; padding: 2px; text-align: center; font-size: .85rem;
  font-weight: 500; white-space: normal; }
table.pictures th[scope=row] { writing-mode: vertical-rl; transform: rotate(180deg); color: var(--muted); }
table.pictures th[scope=row] span { display: block; max-height: 8rem; margin: 0 auto; }
table.pictures tbody td { width: 16rem; }
table.pictures img { display: block; width: 100%; min-width: 8rem; max-width: 16rem;
  background: var(--stage); }
.chart { border-radius: 4px; display: block; width: 100%; min-width: 34rem; height: auto; }
.scale { width: 16rem; height: 12px; image-rendering: pixelated; vertical-align: middle; }
figure { margin: 0; }
figcaption, .note { color: var(--muted); font-size: .92rem; max-width: 60rem; }
.good { color: var(--method-2); } .bad { color: var(--time); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1rem; }
dt { color: var(--muted); } dd { margin: 0; overflow-wrap: anywhere; }
@media (max-width: 36rem) { main { padding: .6rem; } dl { grid-template-columns: 1fr; } dd { margin-bottom: .4rem; } }
@media print { .wide { overflow: visible; } }
";

/// A page in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    parts: Vec<Part>,
}

/// What a page consists of.
#[derive(Clone, Debug)]
enum Part {
    Html(String),
    /// A picture that may be shown smaller, and its text.
    Picture(Picture, String),
}

/// A written page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its size \[bytes\].
    pub bytes: usize,
    /// Side of the squares of pixels that its pictures show as one.
    pub reduced: usize,
}

impl Page {
    /// An empty page with its heading.
    pub fn new(title: &str) -> Self {
        let heading = Part::Html(format!("<h1>{}</h1>\n", escape(title)));
        Self { title: title.to_owned(), parts: vec![heading] }
    }

    fn push(&mut self, html: String) {
        self.parts.push(Part::Html(html));
    }

    /// A heading.
    pub fn heading(&mut self, text: &str) {
        self.push(format!("<h2>{}</h2>\n", escape(text)));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        self.push(format!("<p>{}</p>\n", escape(text)));
    }

    /// A remark in small print.
    pub fn note(&mut self, text: &str) {
        self.push(format!("<p class=\"note\">{}</p>\n", escape(text)));
    }

    /// A list.
    pub fn list(&mut self, items: &[String]) {
        let items = joined(items, |item| format!("<li>{}</li>", escape(item)));
        self.push(format!("<ul>{items}</ul>\n"));
    }

    /// A link on a line of its own.
    pub fn link(&mut self, target: &str, text: &str) {
        self.push(format!("<p><a href=\"{}\">{}</a></p>\n", escape(target), escape(text)));
    }

    /// A link, and what is to be known of it before one follows it.
    pub fn link_with(&mut self, target: &str, text: &str, about: &str) {
        let (target, text, about) = (escape(target), escape(text), escape(about));
        self.push(format!(
            "<p><a href=\"{target}\">{text}</a> <span class=\"note\">({about})</span></p>\n"
        ));
    }

    /// A table; the first column names the rows, columns of words begin at their left.
    pub fn table(&mut self, caption: &str, head: &[&str], rows: &[Vec<String>]) {
        let caption = format!("<caption><span>{}</span></caption>", escape(caption));
        self.push(table(&caption, head, rows));
    }

    /// A long table that is opened by its caption.
    pub fn folded_table(&mut self, caption: &str, head: &[&str], rows: &[Vec<String>]) {
        let table = table("", head, rows);
        let caption = escape(caption);
        self.push(format!("<details><summary>{caption}</summary>{table}</details>\n"));
    }

    /// Pictures in rows and columns with names; each has a text for those who cannot see it.
    pub fn pictures(
        &mut self,
        caption: &str,
        columns: &[String],
        rows: &[(String, Vec<(Picture, String)>)],
    ) {
        let head = joined(columns, |c| format!("<th scope=\"col\">{}</th>", escape(c)));
        self.push(format!(
            "<figure><div class=\"wide\"><table class=\"pictures\"><thead><tr><td></td>{head}</tr></thead><tbody>\n"
        ));
        for (name, pictures) in rows {
            self.push(format!("<tr><th scope=\"row\"><span>{}</span></th>", escape(name)));
            for (picture, alt) in pictures {
                self.push("<td>".to_owned());
                self.parts.push(Part::Picture(picture.clone(), alt.clone()));
                self.push("</td>".to_owned());
            }
            self.push("</tr>\n".to_owned());
        }
        self.push(format!(
            "</tbody></table></div><figcaption>{}</figcaption></figure>\n",
            escape(caption)
        ));
    }

    /// A colour scale with what its ends mean.
    pub fn scale(&mut self, bar: &Picture, low: &str, high: &str) -> Result<()> {
        let alt = format!("colour scale from {low} to {high}");
        let bar = image(&bar.png()?, "image/png", &alt, "scale");
        self.push(format!("<p class=\"note\">{} {bar} {}</p>\n", escape(low), escape(high)));
        Ok(())
    }

    /// A chart.
    pub fn chart(&mut self, svg: &str, alt: &str) {
        let picture = image(svg.as_bytes(), "image/svg+xml", alt, "chart");
        self.push(format!(
            "<figure><div class=\"wide\">{picture}</div><figcaption>{}</figcaption></figure>\n",
            escape(alt)
        ));
    }

    /// Names and values.
    pub fn facts(&mut self, facts: &[(&str, String)]) {
        let facts = joined(facts, |(name, value)| {
            format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value))
        });
        self.push(format!("<dl>{facts}</dl>\n"));
    }

    /// A command to be copied.
    pub fn command(&mut self, command: &str) {
        self.push(format!("<p><code>{}</code></p>\n", escape(command)));
    }

    /// The whole text, with pictures as large as the budget \[bytes\] allows.
    ///
    /// # Errors
    /// If it does not fit even with the smallest.
    pub fn html(&self, budget: usize) -> Result<(String, Written)> {
        let mut bytes = 0;
        for reduced in 1..=SMALLEST {
            let html = self.with_pictures(reduced)?;
            bytes = html.len();
            if bytes <= budget {
                return Ok((html, Written { bytes, reduced }));
            }
        }
        let reason = format!("takes {bytes} bytes, more than the {budget} that it may");
        Err(ValidationError::unusable(&self.title, reason))
    }

    fn with_pictures(&self, reduced: usize) -> Result<String> {
        let mut body = String::new();
        for part in &self.parts {
            match part {
                Part::Html(html) => body.push_str(html),
                Part::Picture(picture, alt) if reduced == 1 => {
                    body.push_str(&image(&picture.png()?, "image/png", alt, ""));
                }
                Part::Picture(picture, alt) => {
                    body.push_str(&image(&picture.reduced(reduced).png()?, "image/png", alt, ""));
                }
            }
        }
        if reduced > 1 {
            let _ = writeln!(
                body,
                "<p class=\"note\">To keep this page small, its pictures show squares of \
                 {reduced} \u{d7} {reduced} pixels as one; the files beside it have all.</p>"
            );
        }
        Ok(format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <link rel=\"icon\" href=\"data:,\">\n\
             <title>{}</title>\n<style>\n{}{STYLE}</style>\n</head>\n<body>\n<main>\n{body}</main>\n</body>\n</html>\n",
            escape(&self.title),
            tpb_page::THEME,
        ))
    }

    /// Writes it, whole or not at all, within the budget of a viewer's page.
    ///
    /// # Errors
    /// Those of [`Page::html`], and if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<Written> {
        let (html, written) = self.html(DEFAULT_BUDGET)?;
        atomic_write(path, |file| std::io::Write::write_all(file, html.as_bytes()))?;
        Ok(written)
    }
}

fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let classes: Vec<&str> = (0..head.len()).map(|column| class(column, rows)).collect();
    let dense = head.len() > COLUMNS;
    let head: Vec<String> = head
        .iter()
        .zip(&classes)
        .map(|(cell, class)| {
            let words = if cell.chars().count() > HEAD { " words" } else { "" };
            format!("<th scope=\"col\" class=\"{class}{words}\">{}</th>", escape(cell))
        })
        .collect();
    let row = |row: &Vec<String>| {
        let cells: Vec<String> = row
            .iter()
            .zip(&classes)
            .map(|(cell, class)| {
                let parts = parts(cell, dense);
                let words = match parts.as_slice() {
                    [_, _, ..] => " parts",
                    _ if cell.len() > WORDS => " words",
                    _ => "",
                };
                let html = match parts.as_slice() {
                    [_, _, ..] => joined(&parts, |part| {
                        format!("<span class=\"whole\">{}</span> ", escape(part))
                    }),
                    _ => escape(cell),
                };
                format!("<td class=\"{class}{words}\">{}</td>", html.trim_end())
            })
            .collect();
        format!("<tr>{}</tr>\n", cells.concat())
    };
    format!(
        "<div class=\"wide\"><table{}>{caption}<thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
        if dense { " class=\"dense\"" } else { "" },
        head.concat(),
        joined(rows, row)
    )
}

/// A value, its error and what follows: where a wide table may break a cell. Words are one part. A
/// dense table may break intervals, too.
fn parts(cell: &str, dense: bool) -> Vec<&str> {
    let numbers = |c: char| c.is_ascii_digit() || "+-[\u{2212}".contains(c);
    if !cell.starts_with(numbers) || cell.len() > WORDS {
        return vec![cell];
    }
    let mut parts = Vec::new();
    let mut rest = cell;
    loop {
        let before =
            [" [", " \u{b1} ", "; "].iter().filter_map(|mark| Some((rest.find(mark)?, mark)));
        let after = rest.find("] ").map(|at| at + 1);
        let at = before.map(|(at, mark)| at + usize::from(*mark == "; ")).chain(after).min();
        let within = rest.find(", ").filter(|_| dense).map(|at| at + 1);
        let Some(at) = at.into_iter().chain(within).min() else { break };
        parts.push(&rest[..at]);
        rest = rest[at..].trim_start();
    }
    parts.push(rest);
    parts
}

/// Whether all that stands in a column begins with a letter.
fn class(column: usize, rows: &[Vec<String>]) -> &'static str {
    let mut cells = rows.iter().filter_map(|row| row.get(column)).filter(|cell| !cell.is_empty());
    if cells.all(|cell| cell.starts_with(char::is_alphabetic)) { "text" } else { "number" }
}

/// The texts of all items, one after the other.
fn joined<T>(items: &[T], text: impl Fn(&T) -> String) -> String {
    items.iter().map(text).collect::<Vec<_>>().concat()
}

fn image(bytes: &[u8], kind: &str, alt: &str, class: &str) -> String {
    let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
    format!(
        "<img{class} src=\"data:{kind};base64,{}\" alt=\"{}\">",
        STANDARD.encode(bytes),
        escape(alt)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_holds_everything_and_asks_the_network_for_nothing() {
        let mut page = Page::new("A <b> & \"c\"");
        page.heading("Heading");
        page.text("1 < 2");
        page.table("Numbers", &["name", "value"], &[vec!["x".into(), "1".into()]]);
        let picture = Picture::filled(2, 2, [1, 2, 3]);
        let rows = [("beams".to_owned(), vec![(picture.clone(), "a \"frame\"".to_owned())])];
        page.pictures("Caption", &["4.2 m".to_owned()], &rows);
        page.scale(&picture, "0", "1").unwrap();
        page.chart("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>", "a curve");
        page.facts(&[("commit", "abc".into())]);
        page.command("cargo xtask reproduce");
        page.link("viewer.html", "viewer");
        let html = page.html(DEFAULT_BUDGET).unwrap().0;
        for part in [
            "<title>A &lt;b&gt; &amp; &quot;c&quot;</title>",
            "1 &lt; 2",
            "alt=\"a &quot;frame&quot;\"",
            "<th scope=\"col\">4.2 m</th>",
            "<th scope=\"col\" class=\"text\">name</th><th scope=\"col\" class=\"number\">value</th>",
            "--accent",
            "<dt>commit</dt><dd>abc</dd>",
            "width=device-width",
        ] {
            assert!(html.contains(part), "{part}");
        }
        assert!(!html.contains("src=\"http") && !html.contains("url("));
        assert_eq!(html.matches("<img").count(), html.matches(" alt=\"").count());
    }

    /// Regression: wide tables had columns off screen.
    #[test]
    fn cells_of_numbers_break_between_their_parts() {
        for (cell, expected) in [
            ("1.2e-3 [1.0e-3, 1.4e-3]", vec!["1.2e-3", "[1.0e-3, 1.4e-3]"]),
            ("[-1.4 %, +0.9 %] agree", vec!["[-1.4 %, +0.9 %]", "agree"]),
            ("7.17e-2 \u{b1} 3.4e-4", vec!["7.17e-2", "\u{b1} 3.4e-4"]),
            (
                "88.8 [65.7, 118]; wall: 79.3 [58.7, 105]",
                vec!["88.8", "[65.7, 118];", "wall: 79.3", "[58.7, 105]"],
            ),
            ("0 to 160", vec!["0 to 160"]),
            ("words [in brackets]", vec!["words [in brackets]"]),
        ] {
            assert_eq!(parts(cell, false), expected);
        }
        assert_eq!(parts("[-1.4 %, +0.9 %] agree", true), ["[-1.4 %,", "+0.9 %]", "agree"]);
        let mut page = Page::new("t");
        page.table("c", &["a", "b"], &[vec!["x".into(), "1.2 [1.0, 1.4]".into()]]);
        let html = page.html(DEFAULT_BUDGET).unwrap().0;
        let cell = "<td class=\"number parts\"><span class=\"whole\">1.2</span> \
                    <span class=\"whole\">[1.0, 1.4]</span></td>";
        assert!(html.contains(cell), "{html}");
    }

    #[test]
    fn the_budget_is_kept_by_smaller_pictures_and_the_page_says_so() {
        // Noise, which no code makes small: 3 bytes for each pixel, and a third for base64.
        let mut rng = tpb_optics::Stream::new(3, 0, 0);
        let mut random = || (256.0 * rng.uniform()) as u8;
        let mut noise = Picture::filled(96, 96, [0; 3]);
        noise.pixels.iter_mut().flatten().for_each(|value| *value = random());
        let mut page = Page::new("Noise");
        page.pictures("Caption", &[], &[("noise".into(), vec![(noise, "noise".into())])]);
        let (whole, written) = page.html(DEFAULT_BUDGET).unwrap();
        assert_eq!(written, Written { bytes: whole.len(), reduced: 1 });
        assert!(!whole.contains("To keep this page small"));
        let bare = Page::new("Noise").html(DEFAULT_BUDGET).unwrap().1.bytes;
        for (budget, reduced) in
            [(whole.len(), 1..=1), (whole.len() - 1, 2..=2), (bare + 2_000, 4..=7)]
        {
            let (html, written) = page.html(budget).unwrap();
            assert!(html.len() <= budget && written.bytes == html.len());
            assert_eq!(written.reduced > 1, html.contains("To keep this page small"));
            assert!(reduced.contains(&written.reduced), "{written:?}");
        }
        assert!(page.html(bare).is_err());
    }
}
