//! Pieces of HTML.

use plotly::Plot;

/// A titled part of the page.
pub(super) fn section(title: &str, lead: &str, content: &str) -> String {
    format!("<section>\n<h2>{title}</h2>\n<p>{lead}</p>\n{content}</section>\n")
}

/// A place for a chart, and the chart for the page's script to draw there.
pub(super) fn chart(id: &str, plot: &Plot) -> String {
    // Inside a script element only "<" could end the text early.
    let json = plot.to_json().replace('<', "\\u003c");
    format!(
        "<div class=\"chart\" id=\"{id}\"></div>\n<script type=\"application/json\" data-chart=\"{id}\">{json}</script>\n"
    )
}

/// A table of names and values.
pub(super) fn table(rows: &[(String, String)]) -> String {
    let rows = concat(rows, |(name, value)| format!("<tr><td>{name}</td><td>{value}</td></tr>"));
    format!("<table>{rows}</table>\n")
}

/// The texts of a list, one after the other.
pub(super) fn concat<T>(list: &[T], text: impl Fn(&T) -> String) -> String {
    list.iter().map(text).collect::<Vec<_>>().concat()
}

/// Text that may stand in HTML.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
