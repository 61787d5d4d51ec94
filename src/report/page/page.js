// Draws every chart of the page; the number drawn is kept on <html> so that a test, or a person, can ask for it.
window.addEventListener("error", (event) => { document.documentElement.dataset.fault = event.message; });
const config = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"] };
const charts = [...document.querySelectorAll("script[data-chart]")].map((source) => {
  const { data, layout } = JSON.parse(source.textContent);
  return Plotly.newPlot(source.dataset.chart, data, layout, config);
});
Promise.all(charts).then(
  () => { document.documentElement.dataset.charts = charts.length; },
  (fault) => { document.documentElement.dataset.fault = String(fault); },
);
