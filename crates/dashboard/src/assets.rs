//! Style and scripts of the page, after those of all pages (`tpb_page`).

/// The page around them, with places `{{…}}` for title, style, data and scripts.
pub(crate) const PAGE: &str = include_str!("../assets/page.html");

/// Style sheets.
pub(crate) const STYLES: [&str; 2] =
    [include_str!("../assets/css/layout.css"), include_str!("../assets/css/overview.css")];

/// Scripts.
pub(crate) const SCRIPTS: [&str; 12] = [
    include_str!("../assets/js/text.js"),
    include_str!("../assets/js/plot.js"),
    include_str!("../assets/js/rows.js"),
    include_str!("../assets/js/details.js"),
    include_str!("../assets/js/overview.js"),
    include_str!("../assets/js/factors.js"),
    include_str!("../assets/js/curves.js"),
    include_str!("../assets/js/benchmarks.js"),
    include_str!("../assets/js/bench-runs.js"),
    include_str!("../assets/js/shelves.js"),
    include_str!("../assets/js/keys.js"),
    include_str!("../assets/js/main.js"),
];
