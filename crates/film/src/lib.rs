//! Transient film: time bins, temporal profiles, energy ledger, statistics over passes, and writers.
