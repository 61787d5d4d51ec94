//! What the README says: its commands run, its files are there, its links lead somewhere.

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).expect("is there")
}

/// Commands of the shell blocks, comments cut off.
fn commands() -> Vec<String> {
    let text = readme();
    let blocks = text.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    let lines =
        blocks.flat_map(|block| block.lines().map(|line| line.split(" #").next().unwrap_or_default()));
    lines.map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

/// Overrides that make a run take a second: a small batch, in the scene's own terms, that is not left to settle.
fn small(arguments: &str) -> [&'static str; 2] {
    let batch = if arguments.contains("sphere") { "batches[0].count=40" } else { "batches[0].mass=G(60)" };
    [batch, "time.settle=For(Ms(100))"]
}

/// The arguments as a shell takes them apart.
fn words(arguments: &str) -> Vec<String> {
    let shell =
        std::process::Command::new("bash").args(["-c", &format!("printf '%s\\n' {arguments}")]).output();
    let shell = shell.expect("bash runs");
    assert!(shell.status.success(), "{arguments}: {}", String::from_utf8_lossy(&shell.stderr));
    String::from_utf8(shell.stdout).expect("is text").lines().map(str::to_owned).collect()
}

#[test]
fn commands_run_as_written() {
    let folder = tempfile::tempdir().expect("can be made");
    let mut ran = 0;
    for line in commands() {
        let Some(arguments) =
            line.strip_prefix("pancoat ").or_else(|| line.strip_prefix("cargo run --release -- "))
        else {
            assert_eq!(line, "bash tests/all.sh", "a command that nothing tests");
            continue;
        };
        let mut command = Command::cargo_bin("pancoat").expect("is built");
        command.current_dir(folder.path()).args(words(arguments));
        if arguments.starts_with("run ") {
            command.args(["--seconds", "0.6", "--quiet"]);
            for set in small(arguments) {
                command.args(["--set", set]);
            }
        }
        command.assert().success();
        ran += 1;
    }
    assert!(ran >= 6, "only {ran} commands found");

    // The table of files against what the first run left.
    let left = fs::read_dir(folder.path().join("runs/round")).expect("a run folder");
    let left: BTreeSet<String> = left
        .map(|entry| entry.expect("is readable").file_name().into_string().expect("is text"))
        .filter(|name| !name.starts_with('.'))
        .collect();
    let text = readme();
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    let told: BTreeSet<String> = rows
        .flat_map(|row| row.split('|').nth(1).unwrap_or_default().split(','))
        .map(|name| name.trim().trim_matches('`').to_owned())
        .collect();
    assert_eq!(left, told);
}

#[test]
fn the_checks_are_the_ones_named() {
    assert!(commands().contains(&"bash tests/all.sh".to_owned()));
    let gate = fs::read_to_string(root().join(".ci/run")).expect("is there");
    assert!(gate.contains("tests/all.sh"));
}

#[test]
fn links_lead_somewhere() {
    let text = readme();
    let links: Vec<&str> = text
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .filter(|l| !l.contains("://"))
        .collect();
    assert!(links.len() >= 3);
    for link in links {
        assert!(root().join(link).exists(), "{link}");
    }
}
