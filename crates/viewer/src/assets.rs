//! Style and scripts of the page, after those of all pages (`tpb_page`).

/// The page around them, with places `{{…}}` for title, style, data and scripts.
pub(crate) const PAGE: &str = include_str!("../assets/page.html");

/// Style sheets.
pub(crate) const STYLES: [&str; 2] =
    [include_str!("../assets/css/layout.css"), include_str!("../assets/css/parts.css")];

/// Scripts.
pub(crate) const SCRIPTS: [&str; 17] = [
    include_str!("../assets/js/unpack.js"),
    include_str!("../assets/js/cube.js"),
    include_str!("../assets/js/format.js"),
    include_str!("../assets/js/state.js"),
    include_str!("../assets/js/colour.js"),
    include_str!("../assets/js/tone.js"),
    include_str!("../assets/js/errors.js"),
    include_str!("../assets/js/views.js"),
    include_str!("../assets/js/stage.js"),
    include_str!("../assets/js/pointer.js"),
    include_str!("../assets/js/readout.js"),
    include_str!("../assets/js/chart.js"),
    include_str!("../assets/js/tables.js"),
    include_str!("../assets/js/player.js"),
    include_str!("../assets/js/controls.js"),
    include_str!("../assets/js/keys.js"),
    include_str!("../assets/js/main.js"),
];
