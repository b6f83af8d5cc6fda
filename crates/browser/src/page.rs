//! A loaded page: scripts, keys, clicks, pictures, and what went wrong.

use std::fmt::Write;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use crate::keys::{self, Modifiers};
use crate::{Browser, BrowserError};

/// Longest wait for a condition \[s\].
const PATIENCE_S: u64 = 120;

/// What a page is looked at through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Width \[CSS pixels\].
    pub width: u32,
    /// Height \[CSS pixels\].
    pub height: u32,
    /// Pixels of the device per CSS pixel.
    pub scale: f64,
    /// Whether it is a phone: touch, and a layout of the page's own width.
    pub phone: bool,
}

impl Viewport {
    /// A desktop, 1440 x 900.
    pub const DESKTOP: Self = Self { width: 1440, height: 900, scale: 1.0, phone: false };
    /// A phone, 390 x 844.
    pub const PHONE: Self = Self { width: 390, height: 844, scale: 2.0, phone: true };
}

/// A page in a browser; it is closed when it is dropped.
pub struct Page<'b> {
    browser: &'b mut Browser,
    target: String,
    session: String,
    problems: Vec<String>,
}

impl<'b> Page<'b> {
    pub(crate) fn open(browser: &'b mut Browser, file: &Path) -> Result<Self, BrowserError> {
        let io = |source| BrowserError::Io { path: file.to_owned(), source };
        let file = file.canonicalize().map_err(io)?;
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let made = browser.call(None, "Target.createTarget", json!({ "url": "about:blank" }))?;
        let target = text(&made["targetId"]);
        let attach = json!({ "targetId": target, "flatten": true });
        let attached = browser.call(None, "Target.attachToTarget", attach)?;
        let session = text(&attached["sessionId"]);
        let mut page = Self { browser, target, session, problems: Vec::new() };
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), json!({}))?;
        }
        page.viewport(Viewport::DESKTOP)?;
        page.go(&address(&file))?;
        Ok(page)
    }

    fn go(&mut self, address: &str) -> Result<(), BrowserError> {
        let result = self.call("Page.navigate", json!({ "url": address }))?;
        match result["errorText"].as_str() {
            Some(reason) => Err(BrowserError::Refused {
                command: format!("opening {address}"),
                reason: reason.to_owned(),
            }),
            None => self.wait_for("document.readyState === 'complete'"),
        }
    }

    /// The value of a script; promises are waited for.
    ///
    /// # Errors
    /// [`BrowserError::Refused`] if it throws, with what it says.
    pub fn evaluate(&mut self, script: &str) -> Result<Value, BrowserError> {
        let parameters =
            json!({ "expression": script, "returnByValue": true, "awaitPromise": true });
        let mut result = self.call("Runtime.evaluate", parameters)?;
        let thrown = &result["exceptionDetails"];
        if thrown.is_null() {
            return Ok(result["result"]["value"].take());
        }
        let reason = thrown["exception"]["description"].as_str().unwrap_or("it threw");
        Err(BrowserError::Refused { command: script.to_owned(), reason: reason.to_owned() })
    }

    /// Waits until a script is true.
    ///
    /// # Errors
    /// [`BrowserError::Never`] after two minutes.
    pub fn wait_for(&mut self, condition: &str) -> Result<(), BrowserError> {
        let deadline = Instant::now() + Duration::from_secs(PATIENCE_S);
        while Instant::now() < deadline {
            if self.evaluate(&format!("Boolean({condition})")).is_ok_and(|value| value == true) {
                return Ok(());
            }
            thread::sleep(Duration::from_millis(20));
        }
        Err(BrowserError::Never {
            condition: condition.to_owned(),
            seconds: PATIENCE_S,
            problems: self.problems().join("; "),
        })
    }

    /// Presses and releases a key: a name such as `ArrowLeft`, or the character that it types.
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn press(&mut self, key: &str) -> Result<(), BrowserError> {
        self.press_with(key, Modifiers::default())
    }

    /// The same, with other keys held down.
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn press_with(&mut self, key: &str, modifiers: Modifiers) -> Result<(), BrowserError> {
        for event in keys::events(key, modifiers) {
            self.call("Input.dispatchKeyEvent", event)?;
        }
        Ok(())
    }

    /// Moves the mouse to a place \[CSS pixels\].
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn move_to(&mut self, x: f64, y: f64) -> Result<(), BrowserError> {
        self.mouse("mouseMoved", x, y)
    }

    /// Clicks at a place \[CSS pixels\].
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn click(&mut self, x: f64, y: f64) -> Result<(), BrowserError> {
        self.move_to(x, y)?;
        self.mouse("mousePressed", x, y)?;
        self.mouse("mouseReleased", x, y)
    }

    fn mouse(&mut self, kind: &str, x: f64, y: f64) -> Result<(), BrowserError> {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event).map(drop)
    }

    /// Taps with a finger \[CSS pixels\].
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn tap(&mut self, x: f64, y: f64) -> Result<(), BrowserError> {
        let points = json!([{ "x": x, "y": y }]);
        let touch = |kind: &str, points: Value| json!({ "type": kind, "touchPoints": points });
        self.call("Input.dispatchTouchEvent", touch("touchStart", points))?;
        self.call("Input.dispatchTouchEvent", touch("touchEnd", json!([]))).map(drop)
    }

    /// Sets what the page is looked at through.
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn viewport(&mut self, viewport: Viewport) -> Result<(), BrowserError> {
        let Viewport { width, height, scale, phone } = viewport;
        let metrics = json!({
            "width": width, "height": height, "deviceScaleFactor": scale, "mobile": phone,
        });
        self.call("Emulation.setDeviceMetricsOverride", metrics)?;
        let touch = json!({ "enabled": phone, "maxTouchPoints": if phone { 5 } else { 1 } });
        self.call("Emulation.setTouchEmulationEnabled", touch).map(drop)
    }

    /// Sets a preference of the reader: `prefers-color-scheme` to `dark`.
    ///
    /// # Errors
    /// [`BrowserError::Silent`].
    pub fn prefer(&mut self, feature: &str, value: &str) -> Result<(), BrowserError> {
        let features = json!({ "features": [{ "name": feature, "value": value }] });
        self.call("Emulation.setEmulatedMedia", features).map(drop)
    }

    /// Writes what is seen as PNG.
    ///
    /// # Errors
    /// [`BrowserError::Silent`], [`BrowserError::Io`].
    pub fn picture(&mut self, path: &Path) -> Result<(), BrowserError> {
        self.capture(path, false)
    }

    /// Writes the whole page as PNG, also what one would scroll to.
    ///
    /// # Errors
    /// [`BrowserError::Silent`], [`BrowserError::Io`].
    pub fn whole_picture(&mut self, path: &Path) -> Result<(), BrowserError> {
        self.capture(path, true)
    }

    fn capture(&mut self, path: &Path, beyond: bool) -> Result<(), BrowserError> {
        let parameters = json!({ "format": "png", "captureBeyondViewport": beyond });
        let picture = self.call("Page.captureScreenshot", parameters)?;
        let text = picture["data"].as_str().unwrap_or_default();
        let io = |source| BrowserError::Io { path: path.to_owned(), source };
        let bytes = STANDARD.decode(text).map_err(|e| io(std::io::Error::other(e)))?;
        std::fs::write(path, bytes).map_err(io)
    }

    /// What went wrong on the page so far: errors and warnings on its console, exceptions,
    /// requests to anything but files and data.
    pub fn problems(&mut self) -> &[String] {
        for event in self.browser.take_events() {
            self.problems.extend(problem(&event));
        }
        &self.problems
    }

    fn call(&mut self, method: &str, parameters: Value) -> Result<Value, BrowserError> {
        self.browser.call(Some(&self.session), method, parameters)
    }
}

impl Drop for Page<'_> {
    fn drop(&mut self) {
        // The browser may have ended before its page.
        let _ = self.browser.call(None, "Target.closeTarget", json!({ "targetId": self.target }));
        let _ = self.browser.take_events();
    }
}

/// The address of a file.
fn address(file: &Path) -> String {
    let mut address = "file://".to_owned();
    for byte in file.to_string_lossy().bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            address.push(char::from(byte));
        } else {
            // Writing to a text cannot fail.
            let _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

/// What an event says is wrong.
fn problem(event: &Value) -> Option<String> {
    let parameters = &event["params"];
    match event["method"].as_str()? {
        "Runtime.consoleAPICalled" => {
            let kind = parameters["type"].as_str()?;
            let said = |argument: &Value| argument["value"].as_str().map(str::to_owned);
            let arguments = parameters["args"].as_array()?.iter().filter_map(said);
            let bad = matches!(kind, "error" | "warning" | "assert");
            bad.then(|| format!("{kind}: {}", arguments.collect::<Vec<_>>().join(" ")))
        }
        "Runtime.exceptionThrown" => {
            let details = &parameters["exceptionDetails"];
            let said = details["exception"]["description"].as_str();
            Some(format!("exception: {}", said.or(details["text"].as_str()).unwrap_or("unknown")))
        }
        "Log.entryAdded" => {
            let entry = &parameters["entry"];
            let bad = matches!(entry["level"].as_str(), Some("error" | "warning"));
            bad.then(|| format!("log: {}", entry["text"].as_str().unwrap_or("unknown")))
        }
        "Network.requestWillBeSent" => {
            let address = parameters["request"]["url"].as_str()?;
            let own = ["file:", "data:", "blob:", "about:"];
            let asked = !own.iter().any(|scheme| address.starts_with(scheme));
            asked.then(|| format!("request to {address}"))
        }
        _ => None,
    }
}
