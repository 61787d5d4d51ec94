//! Pages in a real browser.

use std::path::Path;
use std::process::Command;

/// The page as a browser has it after its scripts have run.
///
/// `None` where there is no Chromium (`apt-get install chromium`), unless `REQUIRE_CHROMIUM` is set.
///
/// # Panics
/// When there is no Chromium and `REQUIRE_CHROMIUM` is set.
pub(crate) fn dump_dom(page: &Path) -> Option<String> {
    let profile = tempfile::tempdir().expect("can be made");
    let dom = run(page, profile.path());
    if dom.is_none() {
        assert!(std::env::var_os("REQUIRE_CHROMIUM").is_none(), "no working chromium");
        eprintln!("no chromium: the page was not opened");
    }
    dom
}

fn run(page: &Path, profile: &Path) -> Option<String> {
    let output = Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--enable-unsafe-swiftshader",
            "--disable-quic",
        ])
        .args([
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(["--window-size=1200,4200", "--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("file://{}", page.display()))
        .output()
        .ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}
