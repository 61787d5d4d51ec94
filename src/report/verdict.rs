//! The report in a few sentences.

use super::ReportData;
use super::html::escape;
use super::number::{percent, signed, significant, time};
use crate::models::{Asymptote, PowerLaw};

/// CoV_inter follows a power law after this coated time, s (Freireich et al. 2015, section 8.1).
const INTER_LAW_FROM: f64 = 10.0;

/// What a reader should know before looking at anything else.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Verdict {
    /// The result in one sentence, as HTML.
    pub(super) headline: String,
    /// What it means, as HTML.
    pub(super) sentences: Vec<String>,
    /// What limits confidence in it, as plain text.
    pub(super) doubts: Vec<String>,
}

/// The power law of CoV_inter after ten seconds of coating.
pub(super) fn inter_law(data: &ReportData) -> Option<PowerLaw> {
    PowerLaw::fit(data.series.iter().filter(|r| r.time_s >= INTER_LAW_FROM).map(|r| (r.time_s, r.cov_inter)))
        .ok()
}

impl Verdict {
    pub(super) fn of(data: &ReportData) -> Self {
        let Some(last) = data.series.last() else {
            return Self {
                headline: "Nothing was coated in this run.".into(),
                sentences: vec!["It shows the motion of the bed only.".into()],
                doubts: data.warnings.clone(),
            };
        };
        let headline = format!(
            "After {} of spraying the coating varies by {} over a tablet and by {} from tablet to tablet.",
            time(last.time_s),
            percent(last.cov_intra),
            percent(last.cov_inter)
        );
        let mut sentences = Vec::new();
        let mut doubts: Vec<String> = data.warnings.iter().map(|w| capitalized(w)).collect();
        for shape in &data.shapes {
            let name =
                if data.shapes.len() > 1 { format!("{}: ", escape(&shape.name)) } else { String::new() };
            if let Some(limit) = &shape.limit {
                let interval = format!("95 % interval {} to {}", percent(limit.low), percent(limit.high));
                if limit.low > 0.0 {
                    sentences.push(format!(
                        "{name}Spraying longer brings the variation over a tablet down to <b>{}</b> ({interval}) and no further.",
                        percent(limit.value)
                    ));
                } else {
                    sentences.push(format!(
                        "{name}No lower limit of the variation over a tablet shows yet: it is at most {} ({interval}).",
                        percent(limit.high)
                    ));
                    doubts.push(
                        "The data do not tell the limit from zero; a longer run narrows its interval.".into(),
                    );
                }
                let law =
                    limit.noise_time_s.map(|k| Asymptote { cov_squared: limit.value.powi(2), noise_time: k });
                if let Some(reached) = law.and_then(|l| l.time_within(0.1)).filter(|_| limit.low > 0.0) {
                    sentences.push(format!(
                        "{name}It comes within a tenth of that limit after {}.",
                        time(reached)
                    ));
                }
                if limit.high - limit.low > 0.2 * limit.value && limit.low > 0.0 {
                    doubts
                        .push(format!("{name}The interval of the limit is wider than a fifth of its value."));
                }
            }
            if let Some(without) = shape.orientation_only {
                sentences.push(format!(
                    "{name}Without the shadows of neighbours that limit would be {}.",
                    percent(without)
                ));
            }
            if let Some(means) = shape.map.as_ref().and_then(super::ThicknessMap::regions) {
                sentences.push(format!(
                    "{name}Caps carry {} times the thickness of the band.",
                    significant(means.ratio(), 3)
                ));
            }
        }
        let fitted = data.shapes.iter().find_map(|shape| shape.inter_exponent);
        let law =
            fitted.map(|e| (e.value, format!("{} to {}", signed(e.low), signed(e.high)))).or_else(|| {
                inter_law(data).map(|law| (law.exponent, format!("± {}", significant(law.exponent_error, 1))))
            });
        match law {
            Some((power, error)) => {
                sentences.push(format!(
                    "The variation between tablets falls as time to the power {} ({error}; −0.50 for well-mixed tablets).",
                    signed(power)
                ));
                if fitted.is_some_and(|e| e.low > -0.5 || e.high < -0.5) {
                    doubts.push("The variation between tablets does not fall as the root of time: they do not mix well.".into());
                }
            }
            None => {
                doubts.push(
                    "The run is too short to check how the variation between tablets falls with time.".into(),
                );
            }
        }
        if data.identity_residual.is_some_and(|r| r > 1e-9) {
            doubts
                .push("The averaging identities do not hold to round-off: do not use these numbers.".into());
        }
        Self { headline, sentences, doubts }
    }
}

/// A warning as a sentence of its own.
fn capitalized(warning: &str) -> String {
    let mut letters = warning.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
