//! Self-contained HTML pages: text, tables, pictures and charts inside one file, in the colours of
//! the comparison page, dark and light, for wide and narrow screens.

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use tpb_film::atomic_write;
use tpb_page::escape;

use super::picture::Picture;
use crate::error::Result;

/// Layout; colours come from the theme.
const STYLE: &str = "
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 72rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.25rem; margin: 2rem 0 .5rem; }
p, li { max-width: 46rem; }
a { color: var(--accent); }
code { background: var(--field); padding: .1em .3em; border-radius: 4px; overflow-wrap: anywhere; }
.wide { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  padding: .6rem; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--muted); padding-bottom: .4rem; }
th, td { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
table.pictures th, table.pictures td { border: 0; padding: 2px; text-align: center; font-size: .85rem;
  font-weight: 500; }
table.pictures th[scope=row] { writing-mode: vertical-rl; transform: rotate(180deg); color: var(--muted); }
table.pictures img { display: block; width: clamp(7rem, 16vw, 16rem); image-rendering: pixelated;
  background: var(--stage); }
.chart { background: #fff; border-radius: 4px; display: block; width: 100%; min-width: 34rem; height: auto; }
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
    body: String,
}

impl Page {
    /// An empty page with its heading.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), body: format!("<h1>{}</h1>\n", escape(title)) }
    }

    /// A heading.
    pub fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escape(text));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escape(text));
    }

    /// A remark in small print.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", escape(text));
    }

    /// A list.
    pub fn list(&mut self, items: &[String]) {
        let items = joined(items, |item| format!("<li>{}</li>", escape(item)));
        let _ = writeln!(self.body, "<ul>{items}</ul>");
    }

    /// A link on a line of its own.
    pub fn link(&mut self, target: &str, text: &str) {
        let _ = writeln!(self.body, "<p><a href=\"{}\">{}</a></p>", escape(target), escape(text));
    }

    /// A table; the first column names the rows.
    pub fn table(&mut self, caption: &str, head: &[&str], rows: &[Vec<String>]) {
        let head = joined(head, |cell| format!("<th scope=\"col\">{}</th>", escape(cell)));
        let row = |row: &Vec<String>| {
            format!("<tr>{}</tr>\n", joined(row, |cell| format!("<td>{}</td>", escape(cell))))
        };
        let rows = joined(rows, row);
        let _ = writeln!(
            self.body,
            "<div class=\"wide\"><table><caption>{}</caption><thead><tr>{head}</tr></thead><tbody>\n{rows}</tbody></table></div>",
            escape(caption)
        );
    }

    /// Pictures in rows and columns with names; each has a text for those who cannot see it.
    pub fn pictures(
        &mut self,
        caption: &str,
        columns: &[String],
        rows: &[(String, Vec<(Picture, String)>)],
    ) -> Result<()> {
        let head = joined(columns, |c| format!("<th scope=\"col\">{}</th>", escape(c)));
        let mut lines = String::new();
        for (name, pictures) in rows {
            let _ = write!(lines, "<tr><th scope=\"row\">{}</th>", escape(name));
            for (picture, alt) in pictures {
                let _ = write!(lines, "<td>{}</td>", image(&picture.png()?, "image/png", alt, ""));
            }
            lines.push_str("</tr>\n");
        }
        let _ = writeln!(
            self.body,
            "<figure><div class=\"wide\"><table class=\"pictures\"><thead><tr><td></td>{head}</tr></thead><tbody>\n{lines}</tbody></table></div><figcaption>{}</figcaption></figure>",
            escape(caption)
        );
        Ok(())
    }

    /// A colour scale with what its ends mean.
    pub fn scale(&mut self, bar: &Picture, low: &str, high: &str) -> Result<()> {
        let alt = format!("colour scale from {low} to {high}");
        let bar = image(&bar.png()?, "image/png", &alt, "scale");
        let _ = writeln!(self.body, "<p class=\"note\">{} {bar} {}</p>", escape(low), escape(high));
        Ok(())
    }

    /// A chart.
    pub fn chart(&mut self, svg: &str, alt: &str) {
        let picture = image(svg.as_bytes(), "image/svg+xml", alt, "chart");
        let _ = writeln!(
            self.body,
            "<figure><div class=\"wide\">{picture}</div><figcaption>{}</figcaption></figure>",
            escape(alt)
        );
    }

    /// Names and values.
    pub fn facts(&mut self, facts: &[(&str, String)]) {
        let facts = joined(facts, |(name, value)| {
            format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value))
        });
        let _ = writeln!(self.body, "<dl>{facts}</dl>");
    }

    /// A command to be copied.
    pub fn command(&mut self, command: &str) {
        let _ = writeln!(self.body, "<p><code>{}</code></p>", escape(command));
    }

    /// The whole text.
    pub fn html(&self) -> String {
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <link rel=\"icon\" href=\"data:,\">\n\
             <title>{}</title>\n<style>\n{}{STYLE}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
            escape(&self.title),
            tpb_page::THEME,
            self.body
        )
    }

    /// Writes it, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        let html = self.html();
        Ok(atomic_write(path, |file| std::io::Write::write_all(file, html.as_bytes()))?)
    }
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
        page.pictures("Caption", &["4.2 m".to_owned()], &rows).unwrap();
        page.scale(&picture, "0", "1").unwrap();
        page.chart("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>", "a curve");
        page.facts(&[("commit", "abc".into())]);
        page.command("cargo xtask reproduce");
        page.link("viewer.html", "viewer");
        let html = page.html();
        for part in [
            "<title>A &lt;b&gt; &amp; &quot;c&quot;</title>",
            "1 &lt; 2",
            "alt=\"a &quot;frame&quot;\"",
            "<th scope=\"col\">4.2 m</th>",
            "--accent",
            "<dt>commit</dt><dd>abc</dd>",
            "width=device-width",
        ] {
            assert!(html.contains(part), "{part}");
        }
        assert!(!html.contains("src=\"http") && !html.contains("url("));
        assert_eq!(html.matches("<img").count(), html.matches(" alt=\"").count());
    }
}
