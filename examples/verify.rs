//! The verification book: every case with a known answer, in one table.
//!
//! ```text
//!   case  quantity                     expected    obtained       error   tolerance   verdict
//!   B1    plateau of the pressure (Pa)      300     300.000    +1.2e-07     5.0e-03   pass
//! ```
//!
//! Each case is a file under `verify/` that reads by itself: source, drawing, data, exact answer. The program fails if any
//! case does. `--case B2` runs one, `--list` names them, `--plots` draws the figures into `out/verify/`, `--quick` runs the
//! book at a reduced size, and `--steps` only shows that it runs: motions cut short are not judged.

#[path = "verify/book.rs"]
pub mod book;
#[path = "support/cli.rs"]
pub mod cli;

use book::sheet::{Row, Sheet, Size};
use book::{CASES, Case};
use clap::Parser;
use cli::{Options, print_json};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

const FIGURES: &str = "out/verify";

#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Options,
    /// Run only these cases, by name.
    #[arg(long, value_name = "NAME")]
    case: Vec<String>,
    /// Name the cases and stop.
    #[arg(long)]
    list: bool,
    /// Draw the figures.
    #[arg(long)]
    plots: bool,
    /// Run at a reduced size.
    #[arg(long)]
    quick: bool,
}

impl Arguments {
    fn size(&self) -> Size {
        match self.common.steps {
            Some(n) => Size::Steps(n),
            None if self.quick => Size::Reduced,
            None => Size::Full,
        }
    }

    /// The cases asked for, in the order of the book.
    fn cases(&self) -> Result<Vec<Case>, String> {
        for name in &self.case {
            if !CASES.iter().any(|case| case.id.eq_ignore_ascii_case(name)) {
                return Err(format!("there is no case {name}: `--list` names them"));
            }
        }
        let is_chosen = |case: &&Case| {
            self.case.is_empty()
                || self
                    .case
                    .iter()
                    .any(|name| case.id.eq_ignore_ascii_case(name))
        };
        Ok(CASES.iter().filter(is_chosen).copied().collect())
    }
}

#[allow(dead_code, reason = "tests run the book themselves")]
fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments = Arguments::parse();
    arguments.common.refuse_replay()?;
    let cases = arguments.cases()?;
    if arguments.list {
        for case in &cases {
            println!("{:<12} {}", case.id, case.title);
        }
        return Ok(ExitCode::SUCCESS);
    }
    let bar = ProgressBar::new(cases.len() as u64);
    bar.set_style(ProgressStyle::with_template(
        "{bar:30} {pos}/{len} cases, {elapsed}  {msg}",
    )?);
    bar.tick();
    let sheets = book::run(&cases, arguments.size(), &|case| {
        bar.set_message(format!("{} done", case.id));
        bar.inc(1);
    });
    bar.finish_and_clear();
    print_table(&sheets);
    for sheet in &sheets {
        for note in &sheet.notes {
            println!("\n{}: {note}", sheet.case);
        }
    }
    if arguments.plots {
        draw(&sheets)?;
    }
    let rows = book::rows(&sheets);
    let failed = rows.iter().filter(|row| row.pass == Some(false)).count();
    let judged = rows.iter().filter(|row| row.pass.is_some()).count();
    println!("\n{} of {judged} verdicts pass", judged - failed);
    if arguments.common.json {
        print_json(&rows);
    }
    Ok(if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

fn draw(sheets: &[Sheet]) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(FIGURES)?;
    for figure in sheets.iter().flat_map(|sheet| &sheet.figures) {
        figure.write(Path::new(FIGURES))?;
    }
    println!("\nfigures are in {FIGURES}/");
    Ok(())
}

fn print_table(sheets: &[Sheet]) {
    for sheet in sheets {
        println!(
            "\n{}  {}  ({:.1} s)",
            sheet.case, sheet.title, sheet.seconds
        );
        println!(
            "  {:<58} {:>13} {:>13} {:>10} {:>10}  verdict",
            "quantity", "expected", "obtained", "error", "tolerance"
        );
        for row in &sheet.rows {
            print_row(row);
        }
    }
}

fn print_row(row: &Row) {
    let tolerance = row.tolerance.map_or("-".into(), |t| format!("{t:.1e}"));
    let verdict = match row.pass {
        Some(true) => "pass",
        Some(false) => "FAIL",
        None => "told",
    };
    println!(
        "  {:<58} {:>13} {:>13} {:>+10.1e} {tolerance:>10}  {verdict}",
        row.quantity,
        number(row.expected),
        number(row.obtained),
        row.error
    );
}

/// Six digits, in the shorter notation.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}
