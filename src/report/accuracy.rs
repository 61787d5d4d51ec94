//! Error against run time: tables and a page of work-precision charts.

use super::charts::ink;
use super::html::{chart, concat, escape, section};
use super::number::significant;
use super::page::document;
use super::tablet_charts::{axis, layout};
use crate::models::Precision;
use plotly::common::{ErrorData, ErrorType, Line, Marker, Mode};
use plotly::layout::AxisType;
use plotly::{Plot, Scatter};
use std::fmt::Write;

/// A difference of zero says something of a setting only if chance alone would make less than this of it.
const TELLING: f64 = 0.05;

/// Energy residual over what was dissipated below which energy is accounted for.
const CLOSED: f64 = 0.01;

/// A choice that was varied.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyAxis {
    /// Its name.
    pub name: String,
    /// What its settings are compared with.
    pub against: String,
    /// What the choice is about, or why its default is what it is.
    pub why: String,
    /// Its settings.
    pub cases: Vec<AccuracyCase>,
}

/// A setting of a choice.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyCase {
    /// What was set.
    pub setting: String,
    /// Whether the scene has it so.
    pub is_default: bool,
    /// How it compares; `None` when a run of it or of the reference failed.
    pub precision: Option<Precision>,
    /// Largest energy residual over what was dissipated; `None` where nothing is elastic.
    pub residual: Option<f64>,
    /// Why a run of it failed.
    pub failure: Option<String>,
}

impl AccuracyAxis {
    /// Columns of [`AccuracyAxis::rows`].
    pub fn header(figures: &[&str]) -> Vec<String> {
        let fixed = ["axis", "setting", "default", "pareto", "cpu_s_per_simulated_s", "error", "noise"];
        let figures = figures.iter().flat_map(|f| [(*f).to_owned(), format!("{f}_half_width")]);
        let fixed = fixed.map(str::to_owned).into_iter().chain(figures);
        fixed.chain(["energy_residual".to_owned(), "failure".to_owned()]).collect()
    }

    /// One row for each setting; what is not known is empty.
    pub fn rows(&self, figures: &[&str]) -> Vec<Vec<String>> {
        let row = |case: &AccuracyCase| {
            let told = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
            let precision = case.precision.as_ref();
            let mut row = vec![
                self.name.clone(),
                case.setting.clone(),
                u8::from(case.is_default).to_string(),
                precision.map_or(String::new(), |p| u8::from(p.on_front).to_string()),
                told(precision.map(|p| p.cost)),
                told(precision.map(|p| p.error)),
                told(precision.map(|p| p.noise)),
            ];
            for k in 0..figures.len() {
                row.push(told(precision.map(|p| p.figures[k].0)));
                row.push(told(precision.map(|p| p.figures[k].1)));
            }
            row.push(told(case.residual));
            row.push(case.failure.clone().unwrap_or_default());
            row
        };
        self.cases.iter().map(row).collect()
    }

    /// What the numbers say about the default.
    fn verdict(&self) -> String {
        let default = self.cases.iter().find(|case| case.is_default);
        let Some((case, now)) = default.and_then(|case| Some((case, case.precision.as_ref()?))) else {
            return format!("{} The default has no result.", self.why);
        };
        let cheaper = self.cases.iter().filter_map(|c| Some((c, c.precision.as_ref()?)));
        let closes = |case: &AccuracyCase| case.residual.is_none_or(|r| r.abs() < CLOSED);
        let as_good =
            cheaper.filter(|(c, p)| p.cost < now.cost && !p.is_seen() && p.noise < TELLING && closes(c));
        let cheapest = as_good.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let seen = if now.error == 0.0 {
            "is the reference itself"
        } else if now.is_seen() {
            "differs from it by more than chance"
        } else {
            "does not differ from it by more than chance"
        };
        let better = match cheapest {
            Some((other, p)) => format!(
                "{} costs {} of it and shows no difference either.",
                other.setting,
                significant(p.cost / now.cost, 2)
            ),
            None => "Nothing that costs less was shown to come as near.".to_owned(),
        };
        format!(
            "{} Compared with {}. The default, {}, {seen} ({} against {} from chance). {better}",
            self.why,
            self.against,
            case.setting,
            percent(now.error),
            percent(now.noise)
        )
    }

    fn chart(&self) -> Plot {
        let mut plot = Plot::new();
        let points = || self.cases.iter().filter_map(|c| Some((c, c.precision.as_ref()?)));
        // A reference has no error: it is drawn at its noise.
        let height = |p: &Precision| if p.error > 0.0 { p.error } else { p.noise.max(1e-6) };
        let mut front: Vec<(f64, f64)> =
            points().filter(|(_, p)| p.on_front).map(|(_, p)| (p.cost, height(p))).collect();
        front.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y) = front.into_iter().unzip();
        let line = Line::new().color(ink::GUIDE).width(1.2);
        plot.add_trace(Scatter::new(x, y).mode(Mode::Lines).line(line).name("Pareto front"));
        for (case, p) in points() {
            let color = if case.is_default { ink::INTER } else { ink::INTRA };
            let bar = ErrorData::new(ErrorType::Data).array(vec![p.noise]).color(ink::GUIDE);
            let name = format!("{}{}", case.setting, if case.is_default { " (default)" } else { "" });
            plot.add_trace(
                Scatter::new(vec![p.cost], vec![height(p)])
                    .mode(Mode::Markers)
                    .marker(Marker::new().color(color).size(10))
                    .error_y(bar)
                    .name(name),
            );
        }
        let (x, y) = ("CPU seconds per simulated second", "difference of the bed's figures");
        let log = |title| axis(title).type_(AxisType::Log);
        plot.set_layout(layout(x, y).x_axis(log(x)).y_axis(log(y)).height(360));
        plot
    }
}

fn percent(share: f64) -> String {
    if share.is_finite() { format!("{} %", significant(100.0 * share, 2)) } else { "–".to_owned() }
}

fn cells(case: &AccuracyCase) -> [String; 7] {
    let of =
        |value: &dyn Fn(&Precision) -> String| case.precision.as_ref().map_or_else(|| "–".to_owned(), value);
    [
        format!("{}{}", case.setting, if case.is_default { " (default)" } else { "" }),
        of(&|p| significant(p.cost, 3)),
        of(&|p| percent(p.error)),
        of(&|p| percent(p.noise)),
        case.residual.map_or_else(|| "–".to_owned(), |r| format!("{r:.1e}")),
        of(&|p| if p.on_front { "yes" } else { "" }.to_owned()),
        case.failure.clone().unwrap_or_default(),
    ]
}

const HEAD: [&str; 7] = [
    "setting",
    "CPU s per simulated s",
    "difference",
    "by chance",
    "energy residual / dissipated",
    "on the front",
    "failure",
];

/// Markdown tables of all choices with what they say.
pub fn accuracy_table(axes: &[AccuracyAxis]) -> String {
    let mut text = String::new();
    for axis in axes {
        let _ = write!(
            text,
            "## {}\n\n{}\n\n| {} |\n|{}\n",
            axis.name,
            axis.verdict(),
            HEAD.join(" | "),
            "---|".repeat(7)
        );
        for case in &axis.cases {
            let _ = writeln!(text, "| {} |", cells(case).join(" | "));
        }
        text.push('\n');
    }
    text
}

/// The page of all choices; `note` says how the runs were made.
pub fn accuracy_page(title: &str, note: &str, axes: &[AccuracyAxis]) -> String {
    let head = concat(&HEAD, |cell| format!("<td>{cell}</td>"));
    let mut body = section(
        "Error against run time",
        "Each choice is varied alone. The difference is the root mean square, over mean speed, kinetic energy, centre angle, \
         angle of repose and, of a bed that was sprayed, CoV_inter and CoV_intra, of what each is off from the reference; \
         “by chance” is the same of the half-widths of their 95 % intervals. On the Pareto front nothing is both cheaper and nearer.",
        &format!("<p>{}</p>\n", escape(note)),
    );
    for axis in axes {
        let rows = concat(&axis.cases, |case| {
            format!("<tr>{}</tr>", concat(&cells(case), |cell| format!("<td>{}</td>", escape(cell))))
        });
        let content = chart(&format!("accuracy-{}", axis.name), &axis.chart());
        let table = format!("<table class=\"sheet\"><tr>{head}</tr>{rows}</table>\n");
        body += &section(&escape(&axis.name), &escape(&axis.verdict()), &(content + &table));
    }
    document(title, &body)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(setting: &str, is_default: bool, numbers: Option<(f64, f64, f64)>) -> AccuracyCase {
        let precision = numbers.map(|(cost, error, noise)| Precision {
            figures: vec![(1.0, 0.1)],
            error,
            noise,
            cost,
            on_front: cost < 2.0,
        });
        let failure = numbers.is_none().then(|| "it <broke>".to_owned());
        AccuracyCase { setting: setting.into(), is_default, precision, residual: Some(-2e-4), failure }
    }

    #[test]
    fn tables_tell_cost_error_default_and_failures() {
        let axis = AccuracyAxis {
            name: "step".into(),
            against: "the finest".into(),
            why: "Why.".into(),
            cases: vec![
                case("coarse", false, Some((1.0, 0.01, 0.03))),
                case("middle", true, Some((2.0, 0.02, 0.03))),
                case("broken", false, None),
                AccuracyCase { residual: Some(0.5), ..case("gaining", false, Some((0.5, 0.01, 0.03))) },
            ],
        };
        let table = accuracy_table(std::slice::from_ref(&axis));
        assert!(
            table.contains(
                "The default, middle, does not differ from it by more than chance (2 % against 3 %"
            ),
            "{table}"
        );
        assert!(table.contains("coarse costs 0.50 of it"), "{table}");
        assert!(table.contains("| broken | – | – | – | -2.0e-4 | – | it <broke> |"), "{table}");
        let page = accuracy_page("t", "n", std::slice::from_ref(&axis));
        assert!(page.contains("it &lt;broke&gt;") && page.contains("data-chart=\"accuracy-step\""));
        let header = AccuracyAxis::header(&["speed"]);
        assert!(axis.rows(&["speed"]).iter().all(|row| row.len() == header.len()));
    }
}
