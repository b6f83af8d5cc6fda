//! Who follows a long task: is told of its steps, and may end it between them.
//!
//! Whatever takes long is kept before it is told, so that a task that was ended can go on later.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Result, ValidationError};

/// A part of a long task.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What is done.
    pub name: String,
    /// Wall time that it is expected to take \[s\].
    pub seconds: f64,
}

impl Step {
    /// A step.
    pub fn new(name: impl Into<String>, seconds: f64) -> Self {
        Self { name: name.into(), seconds }
    }
}

/// A time for people: seconds below two minutes.
pub fn duration(seconds: f64) -> String {
    if seconds < 120.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}

/// A follower of a task; by default one that is told nothing and never ends it.
#[derive(Default)]
pub struct Watch<'a> {
    tell: Option<&'a mut dyn FnMut(&str)>,
    stop: Option<&'a AtomicBool>,
    steps: Vec<Step>,
}

impl<'a> Watch<'a> {
    /// Told of every step; never ends the task.
    pub fn new(tell: &'a mut dyn FnMut(&str)) -> Self {
        Self { tell: Some(tell), ..Self::default() }
    }

    /// Ends the task between two steps once `stop` is true.
    #[must_use]
    pub fn with_stop(self, stop: &'a AtomicBool) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// Knows what is to come.
    #[must_use]
    pub fn with_steps(self, steps: Vec<Step>) -> Self {
        Self { steps, ..self }
    }

    /// Tells that a step begins and, if it is one of those that were to come, what is left from it on.
    ///
    /// # Errors
    /// [`ValidationError::Interrupted`] if the task is to end here.
    pub fn begin(&mut self, name: &str) -> Result<()> {
        self.go_on()?;
        let place = self.steps.iter().position(|step| step.name == name);
        let left = place.map_or(String::new(), |place| {
            let left: f64 = self.steps[place..].iter().map(|step| step.seconds).sum();
            format!(" [{} of {}; about {} left]", place + 1, self.steps.len(), duration(left))
        });
        self.tell(&format!("{name}{left}"));
        Ok(())
    }

    /// Tells of what is done.
    pub fn tell(&mut self, line: &str) {
        if let Some(tell) = &mut self.tell {
            tell(line);
        }
    }

    /// Asked before each step.
    ///
    /// # Errors
    /// [`ValidationError::Interrupted`] if the task is to end here.
    pub fn go_on(&self) -> Result<()> {
        match self.stop {
            Some(stop) if stop.load(Ordering::Relaxed) => Err(ValidationError::Interrupted),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_ends_between_steps_once_it_is_asked_to() {
        let stop = AtomicBool::new(false);
        let mut told = Vec::new();
        let mut tell = |line: &str| {
            told.push(line.to_owned());
            stop.store(told.len() == 2, Ordering::Relaxed);
        };
        let mut watch = Watch::new(&mut tell).with_stop(&stop);
        let mut steps = (0..5).map(|step| {
            watch.go_on()?;
            watch.tell(&format!("step {step}"));
            Ok(())
        });
        let ended: Result<()> = steps.by_ref().collect();
        assert!(matches!(ended, Err(ValidationError::Interrupted)));
        assert_eq!(told, ["step 0", "step 1"]);
    }

    #[test]
    fn steps_tell_what_is_left() {
        let mut told = Vec::new();
        let mut tell = |line: &str| told.push(line.to_owned());
        let steps = vec![Step::new("first", 40.0), Step::new("second", 100.0)];
        let mut watch = Watch::new(&mut tell).with_steps(steps);
        for name in ["first", "second", "another"] {
            watch.begin(name).unwrap();
        }
        let expected =
            ["first [1 of 2; about 2 min left]", "second [2 of 2; about 100 s left]", "another"];
        assert_eq!(told, expected);
    }
}
