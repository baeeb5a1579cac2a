//! One case's answers: rows of the table, notes and figures.

use super::figure::Figure;
use serde::Serialize;

/// How much of the book is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Size {
    /// Everything.
    #[default]
    Full,
    /// Coarser or shorter where a case is slow; the verdicts hold.
    Reduced,
    /// Every motion stops after so many steps: a smoke test, nothing is judged.
    Steps(usize),
}

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub case: &'static str,
    pub quantity: String,
    /// The exact value, or the bound.
    pub expected: f64,
    pub obtained: f64,
    /// `obtained / expected - 1`, or the difference if nothing else is said; for a bound, by how much it is missed.
    pub error: f64,
    /// Largest admissible `|error|`; none for what is told without a verdict.
    pub tolerance: Option<f64>,
    pub pass: Option<bool>,
}

/// The sheet a case writes on.
#[derive(Clone, Debug)]
pub struct Sheet {
    pub case: &'static str,
    pub title: &'static str,
    pub size: Size,
    pub rows: Vec<Row>,
    /// Paragraphs and tables below the case's rows.
    pub notes: Vec<String>,
    pub figures: Vec<Figure>,
    pub seconds: f64,
}

impl Sheet {
    pub fn new(case: &'static str, title: &'static str, size: Size) -> Self {
        Self {
            case,
            title,
            size,
            rows: Vec::new(),
            notes: Vec::new(),
            figures: Vec::new(),
            seconds: 0.0,
        }
    }

    /// The number of steps to take of `full`.
    pub fn n_steps(&self, full: usize) -> usize {
        match self.size {
            Size::Steps(most) => full.min(most),
            _ => full,
        }
    }

    /// `full`, or `reduced` where the book is run at a reduced size.
    pub fn choose<T>(&self, full: T, reduced: T) -> T {
        if self.size == Size::Full {
            full
        } else {
            reduced
        }
    }

    /// Judges `|obtained / expected - 1|`.
    pub fn relative(
        &mut self,
        quantity: impl Into<String>,
        expected: f64,
        obtained: f64,
        tolerance: f64,
    ) {
        let error = obtained / expected - 1.0;
        self.push(
            quantity.into(),
            [expected, obtained, error],
            Some(tolerance),
        );
    }

    /// Judges `|obtained - expected|`.
    pub fn absolute(
        &mut self,
        quantity: impl Into<String>,
        expected: f64,
        obtained: f64,
        tolerance: f64,
    ) {
        let error = obtained - expected;
        self.push(
            quantity.into(),
            [expected, obtained, error],
            Some(tolerance),
        );
    }

    /// Asks for `obtained >= bound`.
    pub fn at_least(&mut self, quantity: impl Into<String>, bound: f64, obtained: f64) {
        // `max` would turn a NaN into a pass.
        let error = if obtained >= bound {
            0.0
        } else {
            obtained - bound
        };
        self.push(quantity.into(), [bound, obtained, error], Some(0.0));
    }

    /// Asks for `obtained <= bound`.
    pub fn at_most(&mut self, quantity: impl Into<String>, bound: f64, obtained: f64) {
        let error = if obtained <= bound {
            0.0
        } else {
            obtained - bound
        };
        self.push(quantity.into(), [bound, obtained, error], Some(0.0));
    }

    /// Tells `obtained / expected - 1` without a verdict: what theory does not promise.
    pub fn tell(&mut self, quantity: impl Into<String>, expected: f64, obtained: f64) {
        let error = obtained / expected - 1.0;
        self.push(quantity.into(), [expected, obtained, error], None);
    }

    /// A failing row for an error that ended the case.
    pub fn fail(&mut self, message: &str) {
        self.notes.push(format!("ended with an error: {message}"));
        self.push("runs to its end".into(), [1.0, 0.0, -1.0], Some(0.0));
    }

    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    pub fn figure(&mut self, figure: Figure) {
        self.figures.push(figure);
    }

    /// The value obtained for a quantity of this sheet; NaN if there is none.
    pub fn obtained(&self, quantity: &str) -> f64 {
        let row = self.rows.iter().find(|row| row.quantity == quantity);
        row.map_or(f64::NAN, |row| row.obtained)
    }

    fn push(
        &mut self,
        quantity: String,
        [expected, obtained, error]: [f64; 3],
        tolerance: Option<f64>,
    ) {
        let is_judged = !matches!(self.size, Size::Steps(_));
        self.rows.push(Row {
            case: self.case,
            quantity,
            expected,
            obtained,
            error,
            tolerance,
            pass: tolerance
                .filter(|_| is_judged)
                .map(|tolerance| error.abs() <= tolerance),
        });
    }
}
