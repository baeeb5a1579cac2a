//! Figures as an engineer would put them in a report: labelled axes with units, the exact solution beside ours.

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// A named curve.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// Exact solutions are drawn black and first.
    pub is_exact: bool,
    /// Drawn as dots, not as a line.
    pub is_dotted: bool,
}

/// A line chart.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of the file without its ending.
    pub name: &'static str,
    pub title: String,
    /// Quantity and unit of the axes.
    pub axes: [&'static str; 2],
    pub curves: Vec<Curve>,
    /// Whether the level and the upright axis are logarithmic.
    pub is_log: [bool; 2],
    /// Values on the upright axis beyond this are cut, where it is given.
    pub range: Option<[f64; 2]>,
}

impl Figure {
    pub fn new(name: &'static str, title: impl Into<String>, axes: [&'static str; 2]) -> Self {
        Self {
            name,
            title: title.into(),
            axes,
            curves: Vec::new(),
            is_log: [false; 2],
            range: None,
        }
    }

    pub fn log(mut self) -> Self {
        self.is_log = [true; 2];
        self
    }

    /// With a level axis that is logarithmic.
    pub fn log_level(mut self) -> Self {
        self.is_log = [true, false];
        self
    }

    /// With an upright axis that is logarithmic.
    pub fn log_upright(mut self) -> Self {
        self.is_log = [false, true];
        self
    }

    pub fn within(mut self, range: [f64; 2]) -> Self {
        self.range = Some(range);
        self
    }

    pub fn exact(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, true, false);
        self
    }

    pub fn line(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, false, false);
        self
    }

    pub fn dots(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, false, true);
        self
    }

    fn push(&mut self, name: &str, points: Vec<[f64; 2]>, is_exact: bool, is_dotted: bool) {
        self.curves.push(Curve {
            name: name.into(),
            points,
            is_exact,
            is_dotted,
        });
    }

    /// Smallest and largest value on an axis, with room around; zero to one without points.
    fn bounds(&self, axis: usize) -> [f64; 2] {
        if let (1, Some(range)) = (axis, self.range) {
            return range;
        }
        let values = self.curves.iter().flat_map(|curve| &curve.points);
        let values = values.map(|point| point[axis]).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        if low > high {
            [0.1, 1.0]
        } else if self.is_log[axis] {
            [0.7 * low.max(1e-300), 1.4 * high.max(1e-299)]
        } else {
            let room = (0.05 * (high - low)).max(1e-12 + 1e-6 * high.abs());
            [
                low - if axis == 1 { room } else { 0.0 },
                high + if axis == 1 { room } else { 0.0 },
            ]
        }
    }

    /// Writes the figure as an SVG file into a folder, with the names of the curves beside it.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        let path = folder.join(format!("{}.svg", self.name));
        let longest = self.curves.iter().map(|curve| curve.name.chars().count());
        let beside = 60 + 7 * longest.max().unwrap_or(0) as u32;
        let root = SVGBackend::new(&path, (WIDTH + beside, HEIGHT)).into_drawing_area();
        root.fill(&WHITE)?;
        let (area, names) = root.split_horizontally(WIDTH);
        let [[x0, x1], [y0, y1]] = [self.bounds(0), self.bounds(1)];
        let mut builder = ChartBuilder::on(&area);
        builder
            .caption(&self.title, ("sans-serif", 17))
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(76);
        let labels: [fn(f64) -> String; 2] = self
            .is_log
            .map(|is_log| if is_log { power as _ } else { short as _ });
        let [x_label, y_label] = labels.map(|label| move |value: &f64| label(*value));
        macro_rules! draw {
            ($chart:expr) => {{
                let mut chart = $chart;
                let [x, y] = self.axes;
                chart
                    .configure_mesh()
                    .x_desc(x)
                    .y_desc(y)
                    .x_label_formatter(&x_label)
                    .y_label_formatter(&y_label)
                    .light_line_style(WHITE)
                    .draw()?;
                for (index, curve) in self.curves.iter().enumerate() {
                    let colour = colour(index, curve);
                    // Far outside the chart a renderer may lose precision.
                    let (reach, low, high) = (y1 - y0, y0, y1);
                    let points = curve
                        .points
                        .iter()
                        .filter(|p| p[0].is_finite() && p[1].is_finite());
                    let points = points.map(|&[x, y]| (x, y.clamp(low - reach, high + reach)));
                    if curve.is_dotted {
                        chart.draw_series(points.map(|at| Circle::new(at, 3, colour.filled())))?;
                    } else {
                        chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?;
                    }
                }
            }};
        }
        match self.is_log {
            [true, true] => {
                draw!(builder.build_cartesian_2d((x0..x1).log_scale(), (y0..y1).log_scale())?);
            }
            [true, false] => draw!(builder.build_cartesian_2d((x0..x1).log_scale(), y0..y1)?),
            [false, true] => draw!(builder.build_cartesian_2d(x0..x1, (y0..y1).log_scale())?),
            [false, false] => draw!(builder.build_cartesian_2d(x0..x1, y0..y1)?),
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let (y, colour) = (48 + 20 * index as i32, colour(index, curve));
            if curve.is_dotted {
                names.draw(&Circle::new((15, y), 3, colour.filled()))?;
            } else {
                let line = vec![(4, y), (26, y)];
                names.draw(&PathElement::new(line, colour.stroke_width(2)))?;
            }
            let style = ("sans-serif", 12).into_text_style(&names);
            names.draw_text(&curve.name, &style, (34, y - 6))?;
        }
        root.present()?;
        Ok(())
    }
}

/// Size of the chart, without the names of its curves (pixels).
const WIDTH: u32 = 720;
const HEIGHT: u32 = 460;

/// Colours that stand out from white and from each other.
const COLOURS: [[u8; 3]; 14] = [
    [31, 119, 180],
    [214, 39, 40],
    [44, 160, 44],
    [255, 127, 14],
    [148, 103, 189],
    [140, 86, 75],
    [227, 119, 194],
    [0, 150, 170],
    [150, 150, 0],
    [110, 110, 110],
    [0, 60, 140],
    [90, 0, 60],
    [240, 180, 0],
    [60, 60, 60],
];

/// Exact solutions are black.
fn colour(index: usize, curve: &Curve) -> RGBAColor {
    if curve.is_exact {
        BLACK.to_rgba()
    } else {
        let [red, green, blue] = COLOURS[index % COLOURS.len()];
        RGBColor(red, green, blue).to_rgba()
    }
}

/// A tick of an even axis, in as few digits as tell it from its neighbours.
fn short(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// A tick of a logarithmic axis: 1, 2 and 5 times powers of ten, others without a number.
fn power(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor();
    let first = value / 10f64.powf(exponent);
    let is_told = [1.0, 2.0, 5.0].iter().any(|d| (first - d).abs() < 1e-6);
    if !is_told {
        String::new()
    } else if (-2.0..4.0).contains(&exponent) {
        short(10f64.powf(exponent) * first.round())
    } else {
        format!("{}e{exponent}", first.round())
    }
}
