//! Plays the imaginary coating process of Freireich et al. 2015, appendix A.6, and draws Fig A1: four ways to average
//! the variation over 1000 tablets of 100 panels, as lines, with their exact expectations as dots.
//!
//! `cargo run --release --example averaging_schemes -- [HTML]` writes the plot (default `averaging_schemes.html`) and
//! prints a table; the last line is the largest difference between the game and its expectation.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use pancoat::models::TrialProcess;
use plotly::common::{Marker, MarkerSymbol, Mode, Title};
use plotly::layout::{Axis, AxisType};
use plotly::{Layout, Plot, Scatter};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "averaging_schemes.html".into());
    let process = TrialProcess::PAPER;
    let mut trials: Vec<u64> = (0..=60).map(|k| 10_f64.powf(f64::from(k) / 15.0).round() as u64).collect();
    trials.dedup();

    let mut played = Vec::new();
    process.play(1, &trials, |trials, batch| {
        played.push((
            trials as f64,
            [batch.moments, batch.average_tablet, batch.total_area, batch.inter],
            batch.each_tablet,
        ));
    })?;

    println!("{:>7} {:>9} {:>9} {:>9} {:>9} {:>9}", "trials", "moments", "average", "total", "inter", "each");
    let mut worst: f64 = 0.0;
    for (trials, found, each) in played.iter().filter(|p| [10.0, 100.0, 1000.0, 10_000.0].contains(&p.0)) {
        let [moments, average, total, inter] = found;
        let each = each.map_or("-".into(), |e| format!("{e:.5}"));
        println!("{trials:>7} {moments:>9.5} {average:>9.5} {total:>9.5} {inter:>9.5} {each:>9}");
        for (f, e) in found.iter().zip(expected(&process, *trials)) {
            worst = worst.max((f / e - 1.0).abs());
        }
    }

    let mut plot = Plot::new();
    for (k, name) in
        ["averaging moments", "average tablet", "total area", "inter-tablet"].into_iter().enumerate()
    {
        let (x, y): (Vec<f64>, Vec<f64>) = played.iter().map(|p| (p.0, p.1[k])).unzip();
        let exact = x.iter().map(|&c| expected(&process, c)[k]).collect();
        plot.add_trace(Scatter::new(x.clone(), y).mode(Mode::Lines).name(name));
        let dots = Marker::new().symbol(MarkerSymbol::CircleOpen).size(5).color("#667085");
        plot.add_trace(
            Scatter::new(x, exact).mode(Mode::Markers).marker(dots).name(format!("{name}, exact")),
        );
    }
    let (x, y): (Vec<f64>, Vec<f64>) = played.iter().filter_map(|p| Some((p.0, p.2?))).unzip();
    plot.add_trace(Scatter::new(x, y).mode(Mode::Lines).name("each tablet"));
    let axis = |title: &str| Axis::new().type_(AxisType::Log).title(Title::with_text(title));
    plot.set_layout(Layout::new().x_axis(axis("coating trials")).y_axis(axis("coefficient of variation")));
    plot.write_html(&file);

    println!("asymptote {:.7}, plot in {file}", process.asymptote());
    println!("largest difference from the exact expectation: {:.2} %", 100.0 * worst);
    Ok(())
}

fn expected(process: &TrialProcess, trials: f64) -> [f64; 4] {
    let e = process.expectation(trials);
    [e.moments, e.average_tablet, e.total_area, e.inter]
}
