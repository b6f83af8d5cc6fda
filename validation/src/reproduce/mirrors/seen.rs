//! What is seen in the frames of *Mirrors*, and where: written by people who looked at them.
//!
//! Each text belongs to the moment that geometry gives its event ([`super::room`]), so that it stays
//! true however long the render was; other cameras, other places of lamp, ball and mirrors need new
//! texts. That things are where the texts say is tested.

/// How the picture is laid out.
pub(super) const LAYOUT: &str = "The picture looks into the room from its open side. Its left fifth is \
    the left mirror, which shows the room once more; the ceiling is above, the floor below, a dark wall \
    at the right. The lamp is in the upper left, the ball just to the lower right of the middle, the \
    tilted mirror at the right border.";

/// The row of continuous emission.
pub(super) const CONTINUOUS: &str = "Below, light stays where it has come: the lamp is a white disc in \
    the upper left with a blue glow on the ceiling above it. The ball's shadow grows from the ball to \
    the lower right; in it the light through the glass is a bright wedge under the ball first, then a \
    cone that ends in a point, and at last it stands on the floor as a small white spot. At the right the \
    tilted mirror lights up. In the last frames a pale disc has spread over the back wall.";

pub(super) const BALL: &str = "Fog is lit within a large disc around the lamp; right of it and below it \
    is dark. The ball shows as a dark oval at the middle: the front has reached its upper side only. At \
    the left border a second disc, brighter, is light that the left mirror throws back. At the top a \
    white arc of each of them runs over the ceiling; they cross in the upper left corner.";

pub(super) const LEFT: &str = "The lit disc has grown to the right border; all of the ball stands in it as \
    a dark disc, with bright specks at its upper left, where the glass mirrors the fog around \
    the lamp. The left of the picture is brighter, up to a border that runs from the ball to the lower \
    left: light off the left mirror.";

pub(super) const LEAVES: &str = "At the ball's lower right edge a bright half disc comes out of the glass. \
    Around and below it the ball's shadow lies dark in the fog, down to the floor, where it is a gap in \
    the white arc of the front. At the right a bright fan opens to the left: light off the tilted mirror. \
    Blue lines of the front are on the ceiling and, above and below that mirror, on the right wall.";

pub(super) const TILTED: &str = "The fan off the tilted mirror has grown to the left, up to the ball. Under \
    the ball's lower right the light through the glass is a small disc with a brighter rim. The floor's \
    white arc has a wide gap right of the middle: the ball's shadow.";

pub(super) const REFLECTED: &str = "The front off the left mirror has no edge in the fog here; it is seen \
    on the floor, where its white arc crosses that of the front in the lower left corner. The fan off the \
    tilted mirror passes over the ball. The disc under the ball's lower right is smaller and brighter.";

pub(super) const WITHOUT: &str = "The light through the glass is a small white disc in the lower right \
    quarter, still above and to the left of the focus. The tilted mirror is a pale plate with sharp \
    borders at the right: it shows lit fog. On the floor two white arcs cross at the lower left; the \
    upper one ends at the ball's shadow.";

pub(super) const BACK: &str = "A white ring has opened at the upper left of the ball: the front on the \
    back wall, around the place next to the lamp. The light through the glass is a white point with a \
    halo, lower right. Under that point a third arc begins on the floor, short and faint: light bent by \
    the outer parts of the ball.";

pub(super) const FOCUS: &str = "The light through the glass is a white point at the lower right, not far \
    above the floor; the arc under it on the floor has grown to both sides. The ring on the back wall is \
    wide now: the ceiling cuts its top off, the ball covers its lower right. At the right border a blue \
    arc on the wall is light off the left mirror.";

pub(super) const CAUSTIC: &str = "The white point has come down onto the floor, lower right: the caustic, \
    the brightest place of a white arc that runs through it to both sides. On the back wall a second \
    ring, off the left mirror, comes in from the left and crosses the first one. The ball has a bright \
    crescent at its left edge.";

pub(super) const RING: &str = "In the ball stands a bright oval: the ring on the back wall, seen through \
    the glass. Right of the ball, at the lower corner of the tilted mirror, is a new white point: light \
    off the left mirror, drawn together by the ball. The rings on the back wall cross at the left, lower \
    than the middle; the tilted mirror cuts the larger one off and shows another piece of it.";
