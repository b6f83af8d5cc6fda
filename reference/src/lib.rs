//! Analytic time-dependent radiative transfer: closed forms and quadrature, no sampling.
