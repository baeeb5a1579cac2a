//! A line chart over time, as part of an SVG.

use std::fmt::Write;

const LEFT: f64 = 48.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 34.0;
const COLOURS: [&str; 4] = ["#1f5fa8", "#c2571a", "#222222", "#3c8d4f"];

/// A named curve.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub values: Vec<f64>,
    pub is_dashed: bool,
}

/// Curves over one axis of time (s).
#[derive(Clone, Debug)]
pub struct Chart {
    /// Quantity and unit.
    pub title: String,
    pub times: Vec<f64>,
    pub curves: Vec<Curve>,
    /// Values at the lower and the upper edge; what lies outside is cut.
    pub range: [f64; 2],
}

impl Chart {
    /// The chart in a box of `width` by `height` pixels; `id` tells it from others in the same file.
    pub fn to_svg(&self, [width, height]: [f64; 2], id: usize) -> String {
        let (w, h) = (width - LEFT - RIGHT, height - TOP - BOTTOM);
        let end = self.times.last().copied().unwrap_or(1.0).max(1e-9);
        let mut svg = format!(
            "<text x=\"0\" y=\"14\" font-weight=\"bold\">{}</text>\n\
             <g transform=\"translate({LEFT},{TOP})\" font-size=\"11\">\
             <clipPath id=\"chart{id}\"><rect width=\"{w:.1}\" height=\"{h:.1}\"/></clipPath>\n",
            self.title
        );
        for tick in ticks(self.range, 5) {
            let y = h - h * (tick - self.range[0]) / (self.range[1] - self.range[0]);
            let _ = writeln!(
                svg,
                "<path d=\"M0 {y:.1}H{w:.1}\" stroke=\"#ddd\"/>\
                 <text x=\"-6\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                y + 4.0,
                short(tick)
            );
        }
        for tick in ticks([0.0, end], 6) {
            let x = w * tick / end;
            let _ = writeln!(
                svg,
                "<path d=\"M{x:.1} 0V{h:.1}\" stroke=\"#eee\"/>\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                h + 14.0,
                short(tick)
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">time (s)</text>\
             <g clip-path=\"url(#chart{id})\">",
            0.5 * w,
            h + 29.0
        );
        for (index, curve) in self.curves.iter().enumerate() {
            self.write_curve(&mut svg, curve, COLOURS[index % COLOURS.len()], [w, h]);
        }
        let _ = writeln!(
            svg,
            "</g><rect width=\"{w:.1}\" height=\"{h:.1}\" fill=\"none\" stroke=\"#666\"/>"
        );
        self.write_names(&mut svg, w);
        svg.push_str("</g>\n");
        svg
    }

    fn write_curve(&self, svg: &mut String, curve: &Curve, colour: &str, [w, h]: [f64; 2]) {
        let end = self.times.last().copied().unwrap_or(1.0).max(1e-9);
        let [low, high] = self.range;
        let mut points = String::new();
        for (time, value) in self.times.iter().zip(&curve.values) {
            // Far outside the box a renderer may lose precision.
            let part = ((value - low) / (high - low)).clamp(-1.0, 2.0);
            let _ = write!(points, "{:.1},{:.1} ", w * time / end, h - h * part);
        }
        let dash = if curve.is_dashed {
            " stroke-dasharray=\"5 3\""
        } else {
            ""
        };
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\"{dash}/>",
            points.trim_end()
        );
    }

    fn write_names(&self, svg: &mut String, w: f64) {
        let mut x = w;
        for (index, curve) in self.curves.iter().enumerate().rev() {
            let colour = COLOURS[index % COLOURS.len()];
            let _ = writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"-6\" text-anchor=\"end\" fill=\"{colour}\">{}</text>",
                curve.name
            );
            x -= 6.4 * curve.name.chars().count() as f64 + 14.0;
        }
    }
}

/// Round numbers within a range, about `n` of them.
fn ticks([low, high]: [f64; 2], n: usize) -> Vec<f64> {
    let raw = (high - low) / n as f64;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .iter()
        .map(|factor| factor * power)
        .find(|&step| step >= raw)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A tick without trailing zeros.
fn short(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}
