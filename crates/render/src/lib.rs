//! The pass loop: methods, budgets, progress, interruption and the report.
