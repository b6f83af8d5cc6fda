//! Other programs side by side with ours: mitransient 1.3.1, transient path tracing on Mitsuba 3
//! (Royo et al. 2025), which is what users would pick instead.
//!
//! * [`translate`]: our scene in its words, or the reason why not.
//! * [`driver`]: its process; a small Python script renders what is asked for.
//! * [`contest`]: both programs in turn at equal CPU seconds, against one reference; [`agreement`]:
//!   whether they render the same.
//! * [`faults`]: what it is known to get wrong on a scene; [`report`]: tables.
//!
//! Conventions are brought together before numbers are compared. The same there and here: world +x is
//! on the left of a camera that looks along +z, row 0 is at the top, a bin holds the radiance that
//! arrived within it, path lengths count the refractive index. Not the same: where path lengths start
//! ([`translate`]), and energy outside the window, which its cube drops (its steady image has it). That they
//! agree is measured in every contest: total of the window, of the steady image, mean arrival.

pub mod agreement;
pub mod contest;
pub mod driver;
pub mod faults;
pub mod report;
pub mod translate;

/// Name of the peer in tables and curves.
pub const NAME: &str = "mitransient";

/// What is installed: packages with their versions. Dr.Jit comes with Mitsuba, in one version each.
pub const PACKAGES: [&str; 2] = ["mitsuba==3.9.1", "mitransient==1.3.1"];
