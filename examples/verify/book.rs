//! The verification book: the list of its cases, and how they are run.
//!
//! To add a case, write its file beside the others and name it in [`CASES`].

pub mod figure;
pub mod scene;
pub mod sheet;

mod adina;
mod b1;
mod b10;
mod b14;
mod b17;
mod b18;
mod b19;
mod b2;
mod b22;
mod b24;
mod b25;
mod b27;
mod b29;
mod b3;
mod b30;
mod b31;
mod b32;
mod b40;
mod b41;
mod b42;
mod b43;
mod b44;
mod b45;
mod b46;
mod b47;
mod b48;
mod b49;
mod b50;
mod b8;
mod b9;
mod bars;
mod column;
mod frame;
mod modes;
mod orders;
mod plain;
mod rods;
mod schemes;
mod statics;
mod tube;
mod wrap;

use sheet::{Row, Sheet, Size};
use std::error::Error;
use std::sync::Mutex;

/// What a case may fail with: an error of the library, which is a finding by itself.
pub type Outcome = Result<(), Box<dyn Error + Send + Sync>>;

/// One case of the book.
#[derive(Clone, Copy)]
pub struct Case {
    /// Its number in the list of benchmarks, or a word.
    pub id: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// Puts the question to the library and writes the answers on the sheet.
    pub run: fn(&mut Sheet) -> Outcome,
}

/// The book, in order.
pub const CASES: &[Case] = &[
    Case {
        id: "B1",
        title: "impacting bar",
        run: b1::run,
    },
    Case {
        id: "B2",
        title: "bouncing bar",
        run: b2::run,
    },
    Case {
        id: "B3",
        title: "two bars collide",
        run: b3::run,
    },
    Case {
        id: "schemes",
        title: "the scheme table",
        run: schemes::run,
    },
    Case {
        id: "ADINA",
        title: "constraint functions beside Lagrange multipliers",
        run: adina::run,
    },
    Case {
        id: "plain",
        title: "plain (C.5) in lasting contact",
        run: plain::run,
    },
    Case {
        id: "B8",
        title: "elastic disc dropped on a rigid floor",
        run: b8::run,
    },
    Case {
        id: "B9",
        title: "contact patch test",
        run: b9::run,
    },
    Case {
        id: "B10",
        title: "Hertz line contact",
        run: b10::run,
    },
    Case {
        id: "B14",
        title: "flat punch",
        run: b14::run,
    },
    Case {
        id: "B17",
        title: "block on an incline",
        run: b17::run,
    },
    Case {
        id: "B18",
        title: "rolling disc",
        run: b18::run,
    },
    Case {
        id: "B19",
        title: "stick-slip oscillator",
        run: b19::run,
    },
    Case {
        id: "B22",
        title: "mass ratio of a million",
        run: b22::run,
    },
    Case {
        id: "B24",
        title: "weight",
        run: b24::run,
    },
    Case {
        id: "B25",
        title: "Cook's membrane",
        run: b25::run,
    },
    Case {
        id: "B27",
        title: "a rod bent to a circle",
        run: b27::run,
    },
    Case {
        id: "B29",
        title: "MacNeal and Harder's straight beam",
        run: b29::run,
    },
    Case {
        id: "B30",
        title: "spin-up beam",
        run: b30::run,
    },
    Case {
        id: "B31",
        title: "cantilever",
        run: b31::run,
    },
    Case {
        id: "B32",
        title: "pendulum",
        run: b32::run,
    },
    Case {
        id: "B40",
        title: "elastica under a load at its end",
        run: b40::run,
    },
    Case {
        id: "B41",
        title: "elastica under its own weight",
        run: b41::run,
    },
    Case {
        id: "B42",
        title: "a force that turns with the end",
        run: b42::run,
    },
    Case {
        id: "B43",
        title: "column between hinges",
        run: b43::run,
    },
    Case {
        id: "B44",
        title: "Lee's frame, past its limit loads",
        run: b44::run,
    },
    Case {
        id: "B45",
        title: "homogeneous large strain",
        run: b45::run,
    },
    Case {
        id: "B46",
        title: "free spinning plate",
        run: b46::run,
    },
    Case {
        id: "B47",
        title: "ring between plates",
        run: b47::run,
    },
    Case {
        id: "B48",
        title: "Cattaneo and Mindlin's cylinders",
        run: b48::run,
    },
    Case {
        id: "B49",
        title: "shallow ironing",
        run: b49::run,
    },
    Case {
        id: "B50",
        title: "patch test of flexible on flexible",
        run: b50::run,
    },
    Case {
        id: "wrap",
        title: "strip over a cylinder",
        run: wrap::run,
    },
    Case {
        id: "tube",
        title: "limit pressure of a tube",
        run: tube::run,
    },
    Case {
        id: "modes",
        title: "natural modes",
        run: modes::run,
    },
    Case {
        id: "orders",
        title: "observed orders of the integrators",
        run: orders::run,
    },
];

/// Runs the cases chosen on two threads and returns their sheets in the order of the book; `done` is told of each.
pub fn run(cases: &[Case], size: Size, done: &(dyn Fn(&Case) + Sync)) -> Vec<Sheet> {
    let next = Mutex::new(0);
    let sheets = Mutex::new(vec![None; cases.len()]);
    let work = || {
        loop {
            let index = {
                let mut next = next.lock().expect("no case panics with the lock");
                *next += 1;
                *next - 1
            };
            let Some(case) = cases.get(index) else {
                return;
            };
            let sheet = run_case(case, size);
            sheets.lock().expect("no case panics with the lock")[index] = Some(sheet);
            done(case);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let sheets = sheets.into_inner().expect("no case panics with the lock");
    sheets.into_iter().flatten().collect()
}

/// A case that ends in an error fails with it as the note.
fn run_case(case: &Case, size: Size) -> Sheet {
    let start = std::time::Instant::now();
    let mut sheet = Sheet::new(case.id, case.title, size);
    if let Err(error) = (case.run)(&mut sheet) {
        sheet.fail(&error.to_string());
    }
    sheet.seconds = start.elapsed().as_secs_f64();
    sheet
}

/// All rows of the sheets, in order.
pub fn rows(sheets: &[Sheet]) -> Vec<Row> {
    sheets
        .iter()
        .flat_map(|sheet| sheet.rows.iter().cloned())
        .collect()
}
