//! The layers of the crate, read off its own sources: imports point downward, rapier stays at the border, and data never
//! makes the library panic.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Layers from the top; members of one layer do not import each other.
const LAYERS: [&[&str]; 13] = [
    &["bin"],
    &["guide"],
    &["doctor", "io"],
    &["pipeline"],
    &["coupling"],
    &["kkt"],
    &["constraint"],
    &["system", "nonlinear"],
    &["large"],
    &["body"],
    &["fe", "integrator"],
    &["linalg", "path"],
    &["math"],
];

/// Modules that may hold rapier's sets; everything below sees copies of what is in them.
const BORDER: [&str; 5] = ["bin", "coupling", "doctor", "io", "pipeline"];

/// Rapier's containers and pipelines.
const SETS: [&str; 13] = [
    "BroadPhaseBvh",
    "CCDSolver",
    "ColliderSet",
    "CollisionPipeline",
    "ImpulseJointSet",
    "IslandManager",
    "MultibodyJointSet",
    "NarrowPhase",
    "PhysicsPipeline",
    "PhysicsWorld",
    "QueryPipeline",
    "RigidBodySet",
    "SoftBodySet",
];

/// What `body` may name of rapier: handles, and settings it only passes on.
const HANDLES_AND_SETTINGS: [&str; 9] = [
    "ActiveCollisionTypes",
    "ActiveEvents",
    "ActiveHooks",
    "CoefficientCombineRule",
    "ColliderHandle",
    "Group",
    "InteractionGroups",
    "InteractionTestMode",
    "RigidBodyHandle",
];

const MOST_LINES: usize = 450;

/// Layers whose modules still import each other in circles.
const IN_CIRCLES: [&str; 2] = ["fe", "path"];

/// Files in which the methods of one type may stand.
const MOST_ROOMS: usize = 3;

/// Types that still have more, and how many: let these numbers fall.
const TOO_WIDE: [(&str, usize); 2] = [("FeasiblePath", 7), ("FlexBody", 5)];

/// One source file: code with comments, literals and test modules blanked out, line by line as in the file.
struct Source {
    /// Path below `src`, with forward slashes.
    name: String,
    /// Module path, such as `["fe", "mesh", "cell"]`.
    module: Vec<String>,
    code: String,
    n_lines: usize,
}

impl Source {
    fn layer(&self) -> &str {
        self.module.first().map_or("", String::as_str)
    }

    fn line_of(&self, offset: usize) -> usize {
        1 + self.code[..offset].matches('\n').count()
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    collect(&root, &mut paths);
    paths.sort();
    assert!(paths.len() > 20, "found {} files below src", paths.len());
    paths.iter().map(|path| read(&root, path)).collect()
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("src can be listed") {
        let path = entry.expect("src can be listed").path();
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            paths.push(path);
        }
    }
}

fn read(root: &Path, path: &Path) -> Source {
    let text = fs::read_to_string(path).expect("a source file is UTF-8");
    let below = path.strip_prefix(root).expect("the file lies below src");
    let mut module: Vec<String> = below
        .with_extension("")
        .iter()
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if module
        .last()
        .is_some_and(|last| last == "mod" || last == "lib")
    {
        module.pop();
    }
    Source {
        name: below.to_string_lossy().replace('\\', "/"),
        module,
        n_lines: text.lines().count(),
        code: without_test_modules(&without_comments(&text)),
    }
}

/// Blanks comments, doc comments and the insides of string and character literals, keeping every line break.
fn without_comments(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = text.as_bytes().to_vec();
    let mut blank = |from: usize, to: usize| {
        for byte in &mut code[from..to] {
            if *byte != b'\n' {
                *byte = b' ';
            }
        }
    };
    let mut at = 0;
    while at < bytes.len() {
        let rest = &text.as_bytes()[at..];
        let end = if rest.starts_with(b"//") {
            at + rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len())
        } else if rest.starts_with(b"/*") {
            at + end_of_block_comment(rest)
        } else if let Some(length) = raw_string(rest) {
            at + length
        } else if rest[0] == b'"' {
            at + end_of_quoted(rest, b'"')
        } else if rest[0] == b'\'' && is_character(rest) {
            at + end_of_quoted(rest, b'\'')
        } else {
            at += 1;
            continue;
        };
        blank(at, end);
        at = end;
    }
    String::from_utf8(code).expect("whole tokens were blanked")
}

fn end_of_block_comment(rest: &[u8]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        if rest[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if rest[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    at
}

/// Length of a raw string literal at the beginning of `rest`.
fn raw_string(rest: &[u8]) -> Option<usize> {
    let hashes = rest
        .strip_prefix(b"r")?
        .iter()
        .take_while(|&&b| b == b'#')
        .count();
    if rest.get(1 + hashes) != Some(&b'"') {
        return None;
    }
    let close: Vec<u8> = std::iter::once(b'"')
        .chain(std::iter::repeat_n(b'#', hashes))
        .collect();
    let body = &rest[2 + hashes..];
    let found = body
        .windows(close.len())
        .position(|window| window == close)?;
    Some(2 + hashes + found + close.len())
}

fn end_of_quoted(rest: &[u8], quote: u8) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != quote {
        at += if rest[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(rest.len())
}

/// Whether a `'` opens a character literal and not a lifetime.
fn is_character(rest: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&rest[1..rest.len().min(12)]);
    let mut characters = text.chars();
    match characters.next() {
        Some('\\') => true,
        Some(_) => characters.next() == Some('\''),
        None => false,
    }
}

/// Blanks items that follow `#[cfg(test)]`, up to the brace that closes them or to their semicolon.
fn without_test_modules(code: &str) -> String {
    let mut kept = code.to_owned();
    while let Some(start) = kept.find("#[cfg(test)]") {
        let mut depth = 0usize;
        let mut end = kept.len();
        for (offset, c) in kept[start..].char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 1 => {
                    end = start + offset + 1;
                    break;
                }
                '}' => depth -= 1,
                ';' if depth == 0 => {
                    end = start + offset + 1;
                    break;
                }
                _ => {}
            }
        }
        let blank: String = kept[start..end]
            .chars()
            .map(|c| if c == '\n' { '\n' } else { ' ' })
            .collect();
        kept.replace_range(start..end, &blank);
    }
    kept
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Identifiers of some code with their offsets.
fn words(code: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, c) in code.char_indices().chain([(code.len(), ' ')]) {
        match (is_word(c), start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                found.push((from, &code[from..at]));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// First identifiers after a path prefix: one, or all of a brace group.
fn heads(after: &str) -> Vec<String> {
    let after = after.trim_start();
    let Some(group) = after.strip_prefix('{') else {
        return after
            .split(|c| !is_word(c))
            .next()
            .filter(|word| !word.is_empty())
            .map(|word| vec![word.to_owned()])
            .unwrap_or_default();
    };
    let (mut depth, mut found, mut item) = (0, Vec::new(), String::new());
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => found.push(std::mem::take(&mut item)),
            _ => {}
        }
        if depth == 0 && c != ',' {
            item.push(c);
        }
    }
    found.push(item);
    found
        .iter()
        .filter_map(|item| item.trim().split(|c| !is_word(c)).next())
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Crate-level modules that a source names, with the offsets: through `crate::`, or by climbing out with `super::`.
fn named_modules(source: &Source) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let code = &source.code;
    for (at, word) in words(code) {
        let mut after = &code[at + word.len()..];
        match word {
            "crate" => {}
            "super" if !code[..at].ends_with("super::") => {
                let mut climbed = 1;
                while let Some(rest) = after.strip_prefix("::super") {
                    climbed += 1;
                    after = rest;
                }
                if climbed < source.module.len() {
                    continue;
                }
            }
            _ => continue,
        }
        if let Some(path) = after.strip_prefix("::") {
            found.extend(heads(path).into_iter().map(|head| (at, head)));
        }
    }
    found
}

fn rank(layer: &str) -> Option<usize> {
    LAYERS.iter().position(|members| members.contains(&layer))
}

/// Fails with one line per violation: file, line, rule.
#[track_caller]
fn assert_none(violations: &[String]) {
    let mut list = String::new();
    for violation in violations {
        let _ = writeln!(list, "  {violation}");
    }
    assert!(
        violations.is_empty(),
        "{} violations:\n{list}",
        violations.len()
    );
}

#[test]
fn every_import_points_to_a_lower_layer() {
    let mut violations = Vec::new();
    for source in sources() {
        let Some(own) = rank(source.layer()) else {
            assert_eq!(source.name, "lib.rs", "{} lies in no layer", source.name);
            continue;
        };
        for (at, named) in named_modules(&source) {
            let Some(other) = rank(&named) else {
                continue;
            };
            if named != source.layer() && other <= own {
                violations.push(format!(
                    "src/{}:{}: `{}` may not import `{named}`: only layers below it",
                    source.name,
                    source.line_of(at),
                    source.layer(),
                ));
            }
        }
    }
    assert_none(&violations);
}

/// Modules of its own layer that a source names: through `crate::`, or by climbing to the layer with `super::`.
fn siblings(source: &Source) -> Vec<String> {
    let mut found = Vec::new();
    let code = &source.code;
    for (at, word) in words(code) {
        let mut after = &code[at + word.len()..];
        if word == "super" && !code[..at].ends_with("super::") {
            let mut climbed = 1;
            while let Some(rest) = after.strip_prefix("::super") {
                climbed += 1;
                after = rest;
            }
            if climbed + 1 != source.module.len() {
                continue;
            }
        } else if word == source.layer() && code[..at].ends_with("crate::") {
        } else {
            continue;
        }
        if let Some(path) = after.strip_prefix("::") {
            found.extend(heads(path));
        }
    }
    found
}

/// By module of a layer, the modules beside it that it names; tests may look wherever they like.
fn imports_within(layer: &str, sources: &[Source]) -> BTreeMap<String, BTreeSet<String>> {
    let is_test = |source: &Source| source.module.iter().any(|part| part == "tests");
    let own = sources
        .iter()
        .filter(|source| source.layer() == layer && source.module.len() > 1 && !is_test(source));
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in own {
        let named = imports.entry(source.module[1].clone()).or_default();
        named.extend(siblings(source));
        named.remove(&source.module[1]);
    }
    let modules: BTreeSet<String> = imports.keys().cloned().collect();
    for named in imports.values_mut() {
        named.retain(|name| modules.contains(name));
    }
    imports
}

/// Modules that are left when those which import none that is left are taken away, again and again: each leads into a circle.
fn in_circles(
    mut imports: BTreeMap<String, BTreeSet<String>>,
) -> BTreeMap<String, BTreeSet<String>> {
    loop {
        let (leaves, others): (BTreeMap<_, _>, BTreeMap<_, _>) =
            imports.into_iter().partition(|(_, named)| named.is_empty());
        imports = others;
        if leaves.is_empty() {
            return imports;
        }
        for named in imports.values_mut() {
            named.retain(|name| !leaves.contains_key(name));
        }
    }
}

#[test]
fn modules_of_a_layer_do_not_import_each_other_in_circles() {
    let sources = sources();
    let mut violations = Vec::new();
    for layer in LAYERS.into_iter().flatten() {
        let circles = in_circles(imports_within(layer, &sources));
        let is_known = IN_CIRCLES.contains(layer);
        assert!(
            !(is_known && circles.is_empty()),
            "`{layer}` has no circles any more: take it off the list"
        );
        if !is_known {
            let told = circles.iter().map(|(module, named)| {
                format!("src/{layer}/{module}.rs imports {named:?} and is imported by one of them")
            });
            violations.extend(told);
        }
    }
    assert_none(&violations);
}

/// Types with methods of their own in some code: `impl Type`, not `impl Trait for Type`.
fn types_with_methods(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for line in code.lines() {
        let Some(mut rest) = line.strip_prefix("impl") else {
            continue;
        };
        if rest.starts_with('<') {
            rest = &rest[end_of_generics(rest)..];
        }
        let Some(rest) = rest.strip_prefix(' ') else {
            continue;
        };
        let name: String = rest.chars().take_while(|&c| is_word(c)).collect();
        let mut after = &rest[name.len()..];
        if after.starts_with('<') {
            after = &after[end_of_generics(after)..];
        }
        // A path goes on with `::`, a trait with `for`.
        if after.trim_start().starts_with('{') || after.trim_start().starts_with("where") {
            found.insert(name);
        }
    }
    found
}

fn end_of_generics(text: &str) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '<' => depth += 1,
            '>' if depth == 1 => return at + 1,
            '>' => depth -= 1,
            _ => {}
        }
    }
    text.len()
}

#[test]
fn a_type_is_a_room_and_has_its_methods_in_few_files() {
    let mut files: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
    for source in sources() {
        for name in types_with_methods(&source.code) {
            let room = (source.layer().to_owned(), name);
            files.entry(room).or_default().push(source.name.clone());
        }
    }
    let mut violations = Vec::new();
    for ((_, name), files) in &files {
        let known = TOO_WIDE.iter().find(|(wide, _)| wide == name);
        let most = known.map_or(MOST_ROOMS, |(_, most)| *most);
        if files.len() > most {
            violations.push(format!(
                "`{name}` has methods in {} files: {files:?}. Take it apart into things that own their data",
                files.len()
            ));
        }
    }
    assert_none(&violations);
}

#[test]
fn rapier_is_named_only_at_the_border() {
    let mut violations = Vec::new();
    for source in sources() {
        let layer = source.layer();
        if source.name == "lib.rs" || source.name == "math/real.rs" || BORDER.contains(&layer) {
            continue;
        }
        let mut refuse = |at: usize, rule: String| {
            violations.push(format!(
                "src/{}:{}: {rule}",
                source.name,
                source.line_of(at)
            ));
        };
        for (at, word) in words(&source.code) {
            let is_rapier = word.starts_with("rapier2d")
                || word == "parry2d"
                || (word == "rapier" && source.code[..at].ends_with("crate::"));
            if !is_rapier {
                continue;
            }
            let path = &source.code[at + word.len()..];
            let names = path
                .strip_prefix("::prelude::")
                .map(heads)
                .unwrap_or_default();
            if layer != "body" {
                refuse(
                    at,
                    format!("`{layer}` may not use rapier: pass it numbers instead"),
                );
            } else if names.is_empty() {
                refuse(
                    at,
                    "`body` names rapier's handles and settings one by one, from its prelude"
                        .into(),
                );
            }
            for name in &names {
                if layer == "body" && !HANDLES_AND_SETTINGS.contains(&name.as_str()) {
                    refuse(
                        at,
                        format!("`body` may not use rapier's `{name}`: handles and settings only"),
                    );
                }
            }
        }
    }
    assert_none(&violations);
}

#[test]
fn only_coupling_pipeline_and_io_touch_rapier_sets() {
    let mut violations = Vec::new();
    for source in sources() {
        if BORDER.contains(&source.layer()) {
            continue;
        }
        for (at, word) in words(&source.code) {
            if SETS.contains(&word) {
                violations.push(format!(
                    "src/{}:{}: `{word}` is rapier's: only `coupling` and what lies above may use it",
                    source.name,
                    source.line_of(at),
                ));
            }
        }
    }
    assert_none(&violations);
}

#[test]
fn library_code_has_no_unwrap_no_expect_no_todo_and_nothing_unsafe() {
    let mut violations = Vec::new();
    for source in sources() {
        let code = &source.code;
        for (at, word) in words(code) {
            let is_method = code[..at].trim_end().ends_with('.');
            let next = code[at + word.len()..].chars().next();
            let rule = match word {
                "unwrap" | "expect" | "unwrap_unchecked" if is_method => {
                    "return an error, or state the invariant with `let else`"
                }
                "todo" | "unimplemented" | "dbg" if next == Some('!') => "finish it",
                "unsafe" => "the crate forbids unsafe code",
                _ => continue,
            };
            violations.push(format!(
                "src/{}:{}: `{word}`: {rule}",
                source.name,
                source.line_of(at)
            ));
        }
    }
    assert_none(&violations);
}

/// Files that only tell, or only check: no step depends on their last digit.
const TELLERS: [&str; 3] = [
    "integrator/amplification.rs",
    "fe/element/conformance/",
    "fe/mesh/quality.rs",
];

#[test]
fn elementary_functions_have_one_place() {
    let functions = [
        "sin", "cos", "sin_cos", "tan", "asin", "acos", "atan", "atan2", "exp", "ln", "log10",
        "log2", "powf", "cbrt", "hypot", "mul_add",
    ];
    let mut violations = Vec::new();
    for source in &sources() {
        let tells = TELLERS.iter().any(|teller| source.name.starts_with(teller));
        if tells || source.name == "math/elementary.rs" {
            continue;
        }
        for (at, word) in words(&source.code) {
            let is_call = source.code[at + word.len()..].starts_with('(');
            if functions.contains(&word) && is_call && source.code[..at].ends_with('.') {
                violations.push(format!(
                    "{}:{}: `.{word}()` is the operating system's: call `math::{word}`",
                    source.name,
                    source.line_of(at)
                ));
            }
        }
    }
    assert_none(&violations);
}

/// Where small numbers are settings, ranges of what may be asked for, or the smallest that may be divided by; and what is still to be told from
/// `math::rounding`.
const SMALL_ELSEWHERE: [&str; 13] = [
    "body/build.rs",
    "constraint/geometry/segment_query.rs",
    "fe/frequency/mod.rs",
    "fe/material/",
    "fe/modes/search.rs",
    "integrator/beta2.rs",
    "io/",
    "kkt/constraint_function/mod.rs",
    "kkt/tolerances.rs",
    "linalg/cone/",
    "math/rounding.rs",
    "nonlinear/newton.rs",
    "path/",
];

/// Literals of `code` that are a billionth or less, with their offsets.
fn tiny_literals(code: &str) -> Vec<(usize, String)> {
    let tiny = |(at, _): (usize, &str)| {
        let exponent: String = code[at + 2..]
            .chars()
            .take_while(char::is_ascii_digit)
            .collect();
        let mantissa = code[..at]
            .chars()
            .rev()
            .take_while(|&c| is_word(c) || c == '.');
        let mantissa: String = mantissa.collect();
        let is_number = mantissa.ends_with(|c: char| c.is_ascii_digit());
        let is_tiny = exponent.parse::<u32>().is_ok_and(|exponent| exponent >= 9);
        (is_number && is_tiny).then(|| {
            (
                at,
                format!("{}e-{exponent}", mantissa.chars().rev().collect::<String>()),
            )
        })
    };
    code.match_indices("e-").filter_map(tiny).collect()
}

#[test]
fn roundings_have_one_place() {
    let mut violations = Vec::new();
    for source in &sources() {
        let mut exempt = SMALL_ELSEWHERE.iter().chain(&TELLERS);
        let tests = source.module.iter().any(|part| part == "tests");
        if tests || exempt.any(|start| source.name.starts_with(start)) {
            continue;
        }
        for (at, literal) in tiny_literals(&source.code) {
            violations.push(format!(
                "src/{}:{}: `{literal}`: name what it rounds, `math::rounding`",
                source.name,
                source.line_of(at)
            ));
        }
    }
    assert_none(&violations);
    let found = tiny_literals("x > 1e-9 && y < 2.5e-12 && z == 1e-8 && value-10 > e-11");
    let found: Vec<String> = found.into_iter().map(|(_, literal)| literal).collect();
    assert_eq!(found, ["1e-9", "2.5e-12"]);
}

/// Values of judgement, `math::judged`: let this number fall. `pipeline/sensitivity` asks what depends on them. Those of `linalg/cone`, `path`,
/// `kkt/follow`, `kkt/cones` and `kkt/tolerances` are still to be declared.
const MOST_JUDGED: usize = 36;

#[test]
fn values_of_judgement_are_counted() {
    let all = sources();
    let declared = all
        .iter()
        .map(|source| source.code.matches("Judged::new(").count());
    let n: usize = declared.sum();
    assert!(
        n <= MOST_JUDGED,
        "{n} values of judgement: derive the new ones"
    );
    assert!(
        n == MOST_JUDGED,
        "only {n} values of judgement are left: lower the number"
    );
}

#[test]
fn no_source_file_outgrows_a_reader() {
    let violations: Vec<String> = sources()
        .iter()
        .filter(|source| source.n_lines >= MOST_LINES)
        .map(|source| {
            format!(
                "src/{}:{}: a file has fewer than {MOST_LINES} lines: split it by noun",
                source.name, source.n_lines
            )
        })
        .collect();
    assert_none(&violations);
}

#[test]
fn the_reader_of_this_test_sees_code_and_nothing_else() {
    let text = "use crate::{fe::mesh, math::{Vec2, Mat2}}; // use crate::kkt;\n\
                /* crate::body */ let s = \"crate::system\"; let r = r#\"crate::\"coupling\"#;\n\
                fn f<'a>(c: char) -> bool { c == '\"' } use super::super::linalg;\n\
                #[cfg(test)]\nmod tests { use crate::pipeline; fn g() { x.unwrap(); } }\n\
                fn last() { y.unwrap() }\n";
    let source = Source {
        name: "sample".into(),
        module: vec!["system".into(), "block".into()],
        code: without_test_modules(&without_comments(text)),
        n_lines: 6,
    };
    let named: Vec<(usize, String)> = named_modules(&source)
        .into_iter()
        .map(|(at, name)| (source.line_of(at), name))
        .collect();
    let expected = [(1, "fe"), (1, "math"), (3, "linalg")];
    assert_eq!(named, expected.map(|(line, name)| (line, name.to_owned())));
    let unwraps: Vec<usize> = words(&source.code)
        .into_iter()
        .filter(|(_, word)| *word == "unwrap")
        .map(|(at, _)| source.line_of(at))
        .collect();
    assert_eq!(unwraps, [6]);
}

#[test]
fn circles_and_rooms_are_found_where_they_are() {
    let imports = |all: &[(&str, &[&str])]| -> BTreeMap<String, BTreeSet<String>> {
        let named = |named: &[&str]| named.iter().map(|&name| name.to_owned()).collect();
        let all = all
            .iter()
            .map(|(module, of)| ((*module).to_owned(), named(of)));
        all.collect()
    };
    assert!(in_circles(imports(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &[])])).is_empty());
    let circle = in_circles(imports(&[
        ("a", &["b"]),
        ("b", &["c"]),
        ("c", &["b", "d"]),
        ("d", &[]),
    ]));
    assert_eq!(circle.keys().collect::<Vec<_>>(), ["a", "b", "c"]);
    let source = Source {
        name: "coupling/deep/one.rs".into(),
        module: ["coupling", "deep", "one"].map(String::from).into(),
        code: "use super::other; use super::super::{far, near::X}; use crate::coupling::last::Y;"
            .into(),
        n_lines: 1,
    };
    assert_eq!(siblings(&source), ["far", "near", "last"]);
    let code = "impl Plain {\nimpl<'a, T: Into<U>> Wide<'a, T> {\nimpl Drop for Loan<'_> {\nimpl From<A> for B {\n\
                    impl Inner {\n";
    let found: Vec<String> = types_with_methods(code).into_iter().collect();
    assert_eq!(found, ["Inner", "Plain", "Wide"]);
}

/// Whether a file, a folder or a module of this path is there: below the repository, or anywhere below `src`.
fn is_there(path: &str, sources: &[Source]) -> bool {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let below = [root.join(path), root.join("src").join(path)];
    let inner = path.strip_suffix(".rs").unwrap_or(path);
    let is_module = |source: &Source| {
        let own = source.name.strip_suffix(".rs").unwrap_or(&source.name);
        format!("/{own}/").contains(&format!("/{inner}/"))
    };
    below
        .iter()
        .any(|path| path.exists() || path.with_extension("rs").exists())
        || sources.iter().any(is_module)
}

/// Documents outlive what they point to, unless somebody looks.
#[test]
fn what_the_documents_point_to_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).expect("a document");
    let sources = sources();
    let (architecture, readme) = (read("ARCHITECTURE.md"), read("README.md"));
    let quoted = architecture.split('`').skip(1).step_by(2);
    let is_path = |one: &&str| {
        one.contains('/')
            && one
                .bytes()
                .all(|byte| byte.is_ascii_lowercase() || b"_/.0123456789".contains(&byte))
    };
    let mut paths: Vec<&str> = quoted.filter(is_path).collect();
    let links = readme.split("](").skip(1);
    let links = links.map(|rest| rest.split([')', '#']).next().unwrap_or(""));
    paths.extend(links.filter(|link| !link.is_empty() && !link.contains("://")));
    assert!(paths.len() > 80, "{} paths are named", paths.len());
    let missing: Vec<String> = paths
        .iter()
        .filter(|path| !is_there(path.trim_end_matches('/'), &sources))
        .map(|path| format!("{path} is named and not there"))
        .collect();
    assert_none(&missing);
    // Examples are told of, and those that are told of are there.
    let listed = readme
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once('`'));
    let listed: BTreeSet<&str> = listed.map(|(name, _)| name).collect();
    let examples = fs::read_dir(root.join("examples")).expect("examples");
    let examples = examples.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    for example in examples.filter_map(|name| name.strip_suffix(".rs").map(str::to_owned)) {
        assert!(
            listed.contains(example.as_str()),
            "README tells nothing of {example}"
        );
    }
}
