//! The report page: one HTML file that works without a network.

use super::html::{chart, concat, escape, section, table};
use super::number::{significant, time};
use super::verdict::Verdict;
use super::{Quantity, ReportData, base64, charts, coating};
use plotly::Plot;
use std::fmt::Write;

/// Colours of the phases of run time.
const PHASES: [&str; 7] = ["#2b5fa8", "#3a8f85", "#c4622d", "#8a6fb0", "#b89b3c", "#6f8fb8", "#98a2b3"];

/// The page of a report: a single HTML text with style, script, charts and pictures inside.
pub fn page(data: &ReportData) -> String {
    let mut body = String::new();
    body += &verdict(data);
    body += &cards(data);
    if !data.series.is_empty() {
        body += &section(
            "Uniformity over time",
            "CoV is standard deviation over mean of the thickness: over one tablet’s surface (intra), and of whole \
             tablets (inter). More time always evens tablets out; it evens a tablet’s surface only down to its limit.",
            &chart("uniformity", &charts::uniformity(data)),
        );
    }
    for (number, shape) in data.shapes.iter().enumerate() {
        body += &coating::sections(number, shape);
    }
    body += &bed(data);
    if !data.series.is_empty() {
        body += &section(
            "Four ways to average a batch",
            "All have the same mean. The average tablet nears the limit first, each tablet and averaging moments agree \
             once every tablet is coated, and the total area mixes both kinds of variation.",
            &(chart("schemes", &charts::schemes(data)) + &identity(data)),
        );
    }
    body += &numerics(data);
    body += &provenance(data);
    document(&data.title, &body)
}

pub(super) fn document(title: &str, body: &str) -> String {
    let title = escape(title);
    let (style, script, plotly) =
        (include_str!("page/page.css"), include_str!("page/page.js"), plotly_script());
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{title} · pancoat</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>\n\
         <header><p>Tablet coating report</p><h1>{title}</h1></header>\n\
         <noscript><p>The charts of this page are drawn by a script inside it.</p></noscript>\n{body}\
         <footer>Made by pancoat {}. This file is complete: it loads nothing from elsewhere.</footer>\n</main>\n\
         {plotly}\n<script>\n{script}</script>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// The chart library's script. What the crate embeds also holds a formula typesetter, which no chart here needs.
fn plotly_script() -> String {
    let mut sources = Plot::offline_js_sources();
    if let Some(end) = sources.find("</script>") {
        sources.truncate(end + "</script>".len());
    }
    sources
}

fn verdict(data: &ReportData) -> String {
    let Verdict { headline, sentences, doubts } = Verdict::of(data);
    let items = concat(&sentences, |s| format!("<li>{s}</li>"));
    let doubts = concat(&doubts, |d| format!("<li>{}</li>", escape(d)));
    let doubts = if doubts.is_empty() { doubts } else { format!("<ul class=\"doubts\">{doubts}</ul>") };
    format!("<div class=\"verdict\"><p class=\"headline\">{headline}</p><ul>{items}</ul>{doubts}</div>\n")
}

fn cards(data: &ReportData) -> String {
    let mut cards = Vec::new();
    if let Some(last) = data.series.last() {
        cards.push((significant(last.cov_intra, 3), "CoV<sub>intra</sub> now".to_string()));
        cards.push((significant(last.cov_inter, 3), "CoV<sub>inter</sub> now".to_string()));
        cards.push((format!("{} µm", significant(last.mean_thickness_um, 3)), "mean thickness".to_string()));
    }
    for shape in &data.shapes {
        if let Some(limit) = &shape.limit {
            cards.push((
                significant(limit.value, 3),
                format!("limit of CoV<sub>intra</sub>, {}", escape(&shape.name)),
            ));
        }
    }
    let cards = concat(&cards, |(value, name)| {
        format!("<div class=\"card\"><b>{value}</b><span>{name}</span></div>")
    });
    if cards.is_empty() { cards } else { format!("<div class=\"cards\">{cards}</div>\n") }
}

fn bed(data: &ReportData) -> String {
    if data.bed.is_empty() && data.picture.is_none() {
        return String::new();
    }
    let figures = quantities(&data.bed);
    let content = match &data.picture {
        Some(png) => {
            let encoded = base64::encode(png);
            let picture = format!("<img alt=\"The bed of tablets\" src=\"data:image/png;base64,{encoded}\">");
            format!("<div class=\"pair\"><div>{picture}</div><div>{figures}</div></div>\n")
        }
        None => figures,
    };
    section(
        "The bed",
        "Averages over the coated time with the standard error of their block means.",
        &content,
    )
}

fn identity(data: &ReportData) -> String {
    let Some(residual) = data.identity_residual else { return String::new() };
    let verdict = if residual < 1e-9 { "holds to round-off" } else { "<b>does not hold</b>" };
    format!(
        "<table><tr><td>σ<sub>T</sub>² = σ<sub>m</sub>² + σ<sub>inter</sub>², equal means, σ<sub>t</sub> ≤ σ<sub>m</sub>: \
         {verdict}</td><td>largest residual {}</td></tr></table>\n",
        significant(residual, 2)
    )
}

fn numerics(data: &ReportData) -> String {
    if data.numerics.is_empty() && data.phases.is_empty() {
        return String::new();
    }
    let total: f64 = data.phases.iter().map(|p| p.1).sum();
    let mut content = quantities(&data.numerics);
    if total > 0.0 {
        let (mut bar, mut key) = (String::new(), String::new());
        for ((name, seconds), color) in data.phases.iter().zip(PHASES.iter().cycle()) {
            let share = 100.0 * seconds / total;
            let _ = write!(bar, "<div style=\"width:{share:.2}%;background:{color}\"></div>");
            let _ = write!(
                key,
                "<span><i style=\"background:{color}\"></i>{} {} ({share:.0} %)</span>",
                escape(name),
                time(*seconds)
            );
        }
        let _ = writeln!(content, "<div class=\"bar\">{bar}</div><div class=\"key\">{key}</div>");
    }
    section("Can the numbers be trusted", "How the run was computed, and where its time went.", &content)
}

fn provenance(data: &ReportData) -> String {
    let rows = concat(&data.provenance, |(name, value)| {
        format!("<tr><td>{}</td><td class=\"long\">{}</td></tr>", escape(name), escape(value))
    });
    let scene = if data.scene_text.is_empty() {
        String::new()
    } else {
        format!(
            "<details><summary>The scene file</summary><pre>{}</pre></details>\n",
            escape(&data.scene_text)
        )
    };
    if rows.is_empty() && scene.is_empty() {
        return String::new();
    }
    section(
        "Where these numbers come from",
        "What is needed to compute them again.",
        &format!("<table>{rows}</table>{scene}"),
    )
}

fn quantities(list: &[Quantity]) -> String {
    let row = |q: &Quantity| {
        let error = q.error.map_or(String::new(), |e| format!(" <i>± {}</i>", significant(e, 2)));
        (escape(&q.name), format!("{}{error} {}", significant(q.value, 4), escape(&q.unit)))
    };
    table(&list.iter().map(row).collect::<Vec<_>>())
}
