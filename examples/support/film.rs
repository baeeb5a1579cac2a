//! A film strip as one SVG: panels with the same view of a scene, a colour bar, and charts below.

use super::chart::Chart;
use super::cli::{Options, print_json};
use clap::Parser;
use foil2d::body::FlexBody;
use serde::Serialize;
use std::error::Error;
use std::fmt::Write;

const MARGIN: f64 = 24.0;
const PANEL_WIDTH: f64 = 640.0;
const GAP: f64 = 14.0;
const LABEL_HEIGHT: f64 = 22.0;
const HEADER_HEIGHT: f64 = 118.0;
const CHART_HEIGHT: f64 = 230.0;

/// Colours from none to full load, dark blue to dark red; luminance rises to the middle.
const COLOURS: [[f64; 3]; 9] = [
    [62.0, 73.0, 137.0],
    [69.0, 117.0, 200.0],
    [66.0, 165.0, 220.0],
    [95.0, 204.0, 190.0],
    [170.0, 225.0, 130.0],
    [240.0, 215.0, 85.0],
    [246.0, 150.0, 55.0],
    [222.0, 75.0, 35.0],
    [150.0, 15.0, 20.0],
];

/// The part of the world that a panel shows (m).
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl View {
    fn scale(&self) -> f64 {
        PANEL_WIDTH / (self.x[1] - self.x[0])
    }

    fn height(&self) -> f64 {
        self.scale() * (self.y[1] - self.y[0])
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [scale * (x - self.x[0]), scale * (self.y[1] - y)]
    }
}

/// What the colours and the arrows mean.
#[derive(Clone, Debug)]
pub struct Legend {
    /// Quantity and unit of the colours.
    pub colours: String,
    /// Value at the upper end of the colours; the lower end is zero.
    pub full: f64,
    /// Length of the arrow of a force (m/N) and the force shown in the legend (N).
    pub arrow: [f64; 2],
    /// Longest arrow drawn (m).
    pub longest: f64,
}

/// Panels of one view, in reading order.
#[derive(Debug)]
pub struct Film {
    title: String,
    notes: Vec<String>,
    view: View,
    legend: Legend,
    panels: Vec<Panel>,
    charts: Vec<Chart>,
}

/// One picture of the strip; drawn in world coordinates (m).
#[derive(Debug)]
pub struct Panel {
    view: View,
    legend: Legend,
    label: String,
    shapes: String,
}

/// Colour of a value between 0 and 1, clamped.
pub fn colour(fraction: f64) -> String {
    let at = fraction.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let low = (at as usize).min(COLOURS.len() - 2);
    let mix =
        |i: usize| COLOURS[low][i] + (at - low as f64) * (COLOURS[low + 1][i] - COLOURS[low][i]);
    format!(
        "#{:02x}{:02x}{:02x}",
        mix(0) as u8,
        mix(1) as u8,
        mix(2) as u8
    )
}

/// A number a little above `value` whose first digit is followed by zeros or a five.
pub fn round_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let step = steps.iter().find(|&&step| step * power >= value);
    step.unwrap_or(&10.0) * power
}

impl Panel {
    /// Adds a filled polygon; `style` is SVG's.
    pub fn polygon(&mut self, points: impl IntoIterator<Item = [f64; 2]>, style: &str) {
        self.path(points, style, "polygon");
    }

    /// Adds a line through points.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, style: &str) {
        self.path(points, &format!("fill=\"none\" {style}"), "polyline");
    }

    fn path(&mut self, points: impl IntoIterator<Item = [f64; 2]>, style: &str, kind: &str) {
        let mut list = String::new();
        for point in points {
            let [x, y] = self.view.place(point);
            let _ = write!(list, "{x:.2},{y:.2} ");
        }
        let _ = writeln!(
            self.shapes,
            "<{kind} points=\"{}\" {style}/>",
            list.trim_end()
        );
    }

    /// Adds a cell in the colour of its value.
    pub fn cell(&mut self, points: impl IntoIterator<Item = [f64; 2]>, value: f64) {
        let fill = colour(value / self.legend.full);
        let style = format!("fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"0.4\"");
        self.polygon(points, &style);
    }

    /// Adds the cells of a body in the colours of its von Mises stress, in units of so many Pa.
    pub fn stress(&mut self, body: &FlexBody, unit: f64) -> Result<(), Box<dyn Error>> {
        let stress = body.von_mises()?;
        for cell in body.mesh().cells() {
            let corners = cell.corners();
            let mean = corners.iter().map(|&node| stress[node]).sum::<f64>();
            let points = corners.iter().map(|&node| body.position(node));
            self.cell(points, mean / corners.len() as f64 / unit);
        }
        Ok(())
    }

    /// Adds the contact forces on the nodes of a body.
    pub fn contact_forces(&mut self, body: &FlexBody) {
        for node in 0..body.n_nodes() {
            self.force(body.position(node), body.contact_force(node), FORCE);
        }
    }

    /// Adds a disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, style: &str) {
        let [x, y] = self.view.place(centre);
        let r = radius * self.view.scale();
        let _ = writeln!(
            self.shapes,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\" {style}/>"
        );
    }

    /// Adds a force (N) as an arrow whose tip is where it acts.
    pub fn force(&mut self, tip: [f64; 2], force: [f64; 2], colour: &str) {
        let size = force[0].hypot(force[1]);
        let length = (size * self.legend.arrow[0]).min(self.legend.longest);
        let pixels = length * self.view.scale();
        if pixels < 2.0 {
            return;
        }
        let [x, y] = self.view.place(tip);
        let direction = [force[0] / size, -force[1] / size];
        self.shapes
            .push_str(&arrow([x, y], direction, pixels, colour));
    }
}

/// An arrow in pixels.
fn arrow([x, y]: [f64; 2], [dx, dy]: [f64; 2], length: f64, colour: &str) -> String {
    let head = length.min(8.0);
    let half = 0.38 * head;
    let [nx, ny] = [x - head * dx, y - head * dy];
    let [sx, sy] = [x - length * dx, y - length * dy];
    format!(
        "<path d=\"M{sx:.2} {sy:.2}L{nx:.2} {ny:.2}\" stroke=\"{colour}\" stroke-width=\"1.8\"/>\
         <path d=\"M{x:.2} {y:.2}L{:.2} {:.2}L{:.2} {:.2}Z\" fill=\"{colour}\"/>\n",
        nx - half * dy,
        ny + half * dx,
        nx + half * dy,
        ny - half * dx,
    )
}

impl Film {
    /// An empty strip.
    pub fn new(title: &str, notes: Vec<String>, view: View, legend: Legend) -> Self {
        Self {
            title: title.to_owned(),
            notes,
            view,
            legend,
            panels: Vec::new(),
            charts: Vec::new(),
        }
    }

    /// Appends a panel and hands it out to be drawn on.
    pub fn panel(&mut self, label: String) -> &mut Panel {
        self.panels.push(Panel {
            view: self.view,
            legend: self.legend.clone(),
            label,
            shapes: String::new(),
        });
        self.panels.last_mut().expect("a panel was just pushed")
    }

    /// Appends a chart to the row below the panels.
    pub fn chart(&mut self, chart: Chart) {
        self.charts.push(chart);
    }

    /// Runs an example with the arguments of the program and tells its headline numbers; the film of a whole run is `out/{name}.svg`.
    pub fn record<T: Serialize>(
        mut self,
        name: &str,
        run: impl FnOnce(&Options, Option<&mut Self>) -> Result<T, Box<dyn Error>>,
    ) -> Result<(), Box<dyn Error>> {
        let options = Options::parse();
        let outcome = run(&options, Some(&mut self))?;
        if options.steps.is_none() {
            std::fs::create_dir_all("out")?;
            let path = format!("out/{name}.svg");
            std::fs::write(&path, self.to_svg())?;
            println!("film strip: {path}");
        }
        print_json(&outcome);
        Ok(())
    }

    /// The whole strip.
    pub fn to_svg(&self) -> String {
        let width = 2.0 * MARGIN + 2.0 * PANEL_WIDTH + GAP;
        let row = LABEL_HEIGHT + self.view.height() + GAP;
        let below = HEADER_HEIGHT + row * self.panels.len().div_ceil(2) as f64;
        let charts = if self.charts.is_empty() {
            0.0
        } else {
            CHART_HEIGHT
        };
        let height = below + charts + MARGIN;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width} {height:.0}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" \
             font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        self.write_header(&mut svg, width);
        for (index, panel) in self.panels.iter().enumerate() {
            let x = MARGIN + (index % 2) as f64 * (PANEL_WIDTH + GAP);
            let y = HEADER_HEIGHT + (index / 2) as f64 * row;
            self.write_panel(&mut svg, panel, index, [x, y]);
        }
        let n_charts = self.charts.len() as f64;
        let chart_width = (width - 2.0 * MARGIN - GAP * (n_charts - 1.0)) / n_charts;
        for (index, chart) in self.charts.iter().enumerate() {
            let x = MARGIN + index as f64 * (chart_width + GAP);
            let size = [chart_width, CHART_HEIGHT];
            let _ = writeln!(
                svg,
                "<g transform=\"translate({x:.1},{below:.1})\">\n{}</g>",
                chart.to_svg(size, index)
            );
        }
        svg.push_str("</svg>\n");
        svg
    }

    fn write_header(&self, svg: &mut String, width: f64) {
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"36\" font-size=\"20\" font-weight=\"bold\">{}</text>",
            self.title
        );
        for (line, note) in self.notes.iter().enumerate() {
            let y = 58.0 + 16.0 * line as f64;
            let _ = writeln!(
                svg,
                "<text x=\"{MARGIN}\" y=\"{y}\" fill=\"#444\">{note}</text>"
            );
        }
        self.write_colour_bar(svg, width - MARGIN - 300.0, 300.0);
        let [per_newton, shown] = self.legend.arrow;
        let length = per_newton * shown * self.view.scale();
        let x = width - MARGIN - 300.0;
        svg.push_str(&arrow([x + length, 92.0], [1.0, 0.0], length, FORCE));
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"96\">contact force {:.0} kN</text>",
            x + length + 8.0,
            shown / 1e3
        );
    }

    fn write_colour_bar(&self, svg: &mut String, x: f64, width: f64) {
        svg.push_str("<defs><linearGradient id=\"bar\">");
        for (index, _) in COLOURS.iter().enumerate() {
            let at = index as f64 / (COLOURS.len() - 1) as f64;
            let _ = write!(
                svg,
                "<stop offset=\"{at:.4}\" stop-color=\"{}\"/>",
                colour(at)
            );
        }
        svg.push_str("</linearGradient></defs>\n");
        let _ = writeln!(
            svg,
            "<text x=\"{x}\" y=\"30\">{}</text>\
             <rect x=\"{x}\" y=\"38\" width=\"{width}\" height=\"14\" fill=\"url(#bar)\" stroke=\"#222\" stroke-width=\"0.6\"/>",
            self.legend.colours
        );
        for tick in 0..=4 {
            let part = f64::from(tick) / 4.0;
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"67\" text-anchor=\"middle\">{}</text>",
                x + part * width,
                part * self.legend.full
            );
        }
    }

    fn write_panel(&self, svg: &mut String, panel: &Panel, index: usize, [x, y]: [f64; 2]) {
        let height = self.view.height();
        let _ = writeln!(
            svg,
            "<g transform=\"translate({x:.1},{y:.1})\"><text x=\"0\" y=\"15\" font-weight=\"bold\">{}</text>\n\
             <g transform=\"translate(0,{LABEL_HEIGHT})\"><clipPath id=\"panel{index}\"><rect width=\"{PANEL_WIDTH}\" height=\"{height:.1}\"/></clipPath>\n\
             <rect width=\"{PANEL_WIDTH}\" height=\"{height:.1}\" fill=\"#f6f8fa\" stroke=\"#bbb\"/>\n\
             <g clip-path=\"url(#panel{index})\">\n{}</g></g></g>",
            panel.label, panel.shapes
        );
    }
}

/// Colour of force arrows.
pub const FORCE: &str = "#b3005e";
