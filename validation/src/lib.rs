//! Validation: experiments, statistics of comparison, equal-time runs, negative controls.
