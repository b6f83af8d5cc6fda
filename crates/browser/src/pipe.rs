//! The process, and commands to it with their answers.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::page::Page;
use crate::{BrowserError, program};

/// Longest wait for an answer; machines in use by others are slow.
const PATIENCE: Duration = Duration::from_mins(2);

/// Longest wait for the end of the process.
const FAREWELL: Duration = Duration::from_secs(5);

/// Standard input becomes descriptor 3, standard output 4.
const SHELL: &str = r#"exec "$@" 3<&0 4>&1 0</dev/null 1>&2"#;

/// A running browser; it ends when it is dropped.
pub struct Browser {
    child: Child,
    input: ChildStdin,
    messages: Receiver<Value>,
    last_id: u64,
    /// Events that came while an answer was waited for.
    events: Vec<Value>,
    folder: TempDir,
}

impl Browser {
    /// Starts a browser with an empty profile.
    ///
    /// # Errors
    /// [`BrowserError::Missing`], [`BrowserError::Start`].
    pub fn start() -> Result<Self, BrowserError> {
        let program = program::find()?;
        let failed = |reason: String| BrowserError::Start { program: program.clone(), reason };
        let folder = tempfile::Builder::new().prefix("tpb-browser-").tempdir();
        let folder = folder.map_err(|e| failed(format!("no temporary folder: {e}")))?;
        let log = fs::File::create(folder.path().join("log")).map_err(|e| failed(e.to_string()))?;
        let mut command = Command::new("sh");
        command.args(["-c", SHELL, "sh"]).arg(&program);
        command.args(program::arguments(&folder.path().join("profile")));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(log);
        let mut child = command.spawn().map_err(|e| failed(e.to_string()))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(failed("no pipes to it".to_owned()));
        };
        let (sender, messages) = channel();
        thread::spawn(move || {
            for message in BufReader::new(output).split(0).map_while(Result::ok) {
                let Ok(message) = serde_json::from_slice(&message) else { continue };
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let mut browser = Self { child, input, messages, last_id: 0, events: Vec::new(), folder };
        match browser.call(None, "Browser.getVersion", json!({})) {
            Ok(_) => Ok(browser),
            Err(_) => Err(failed(browser.log())),
        }
    }

    /// Loads a file into a new page.
    ///
    /// # Errors
    /// [`BrowserError::Silent`], [`BrowserError::Refused`].
    pub fn open(&mut self, file: &Path) -> Result<Page<'_>, BrowserError> {
        Page::open(self, file)
    }

    /// Sends a command and waits for its answer.
    pub(crate) fn call(
        &mut self,
        session: Option<&str>,
        method: &str,
        parameters: Value,
    ) -> Result<Value, BrowserError> {
        self.last_id += 1;
        let id = self.last_id;
        let mut command = json!({ "id": id, "method": method });
        command["params"] = parameters;
        if let Some(session) = session {
            command["sessionId"] = json!(session);
        }
        let mut text = command.to_string().into_bytes();
        text.push(0);
        let silent = |reason: String| BrowserError::Silent { command: method.to_owned(), reason };
        let sent = self.input.write_all(&text).and_then(|()| self.input.flush());
        sent.map_err(|e| silent(e.to_string()))?;
        let deadline = Instant::now() + PATIENCE;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.messages.recv_timeout(left) {
                Ok(message) if message["id"] == id => {
                    return answer(method, message);
                }
                Ok(message) => self.events.push(message),
                Err(RecvTimeoutError::Timeout) => return Err(silent("it took too long".into())),
                Err(RecvTimeoutError::Disconnected) => return Err(silent(self.log())),
            }
        }
    }

    /// Events since the last time.
    pub(crate) fn take_events(&mut self) -> Vec<Value> {
        self.events.extend(self.messages.try_iter());
        std::mem::take(&mut self.events)
    }

    /// The last lines of its own log.
    fn log(&self) -> String {
        let text = fs::read(self.folder.path().join("log")).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let lines: Vec<&str> = text.lines().rev().take(5).collect();
        let lines: Vec<&str> = lines.into_iter().rev().collect();
        if lines.is_empty() { "it ended without a word".to_owned() } else { lines.join(" | ") }
    }
}

fn answer(method: &str, mut message: Value) -> Result<Value, BrowserError> {
    let error = &message["error"];
    if error.is_null() {
        return Ok(message["result"].take());
    }
    let reason = error["message"].as_str().map_or_else(|| error.to_string(), str::to_owned);
    Err(BrowserError::Refused { command: method.to_owned(), reason })
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may be gone already, which is as well.
        let _ = self.input.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        let _ = self.input.flush();
        let deadline = Instant::now() + FAREWELL;
        while Instant::now() < deadline {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
