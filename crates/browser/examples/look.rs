//! A picture of a page: `look PAGE PICTURE [phone] [dark] [whole] [link=FRAGMENT] [press=KEY]...`
//!
//! Problems of the page go to standard error and make the exit code 1.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use tpb_browser::{Browser, Viewport};

#[expect(clippy::print_stderr, reason = "a tool for a person")]
fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(page), Some(picture)) = (arguments.next(), arguments.next()) else {
        return Err("look PAGE PICTURE [phone] [dark] [whole] [link=FRAGMENT] [press=KEY]".into());
    };
    let options: Vec<String> = arguments.collect();
    let has = |name: &str| options.iter().any(|option| option == name);
    let picture = PathBuf::from(picture);
    let mut browser = Browser::start()?;
    let mut page = browser.open(&PathBuf::from(page))?;
    page.prefer("prefers-color-scheme", if has("dark") { "dark" } else { "light" })?;
    page.viewport(if has("phone") { Viewport::PHONE } else { Viewport::DESKTOP })?;
    page.wait_for("!window.tpbViewer === !document.getElementById('stage')")?;
    page.wait_for("!window.tpbDashboard === !document.getElementById('experiments')")?;
    for option in &options {
        if let Some(link) = option.strip_prefix("link=") {
            page.evaluate(&format!("location.hash = '{link}'"))?;
        } else if let Some(key) = option.strip_prefix("press=") {
            page.press(key)?;
        }
    }
    page.evaluate("new Promise((done) => setTimeout(done, 400))")?;
    if has("whole") {
        page.whole_picture(&picture)?;
    } else {
        page.picture(&picture)?;
    }
    let problems = page.problems();
    for problem in problems {
        eprintln!("{problem}");
    }
    Ok(if problems.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
