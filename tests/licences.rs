//! Licences of all dependencies, of every platform and feature, are among those that `deny.toml` allows.
//!
//! It asks cargo for all packages, which may download some: `.ci/run` runs it by its name, and `cargo test` leaves it out.

use spdx::Expression;
use std::collections::BTreeSet;
use std::process::Command;

/// The licences that `deny.toml` allows.
fn allowed() -> BTreeSet<String> {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/deny.toml"));
    let (_, list) = text
        .as_deref()
        .expect("deny.toml")
        .split_once("\nallow = [")
        .expect("the list of licences");
    let (list, _) = list.split_once(']').expect("its end");
    let names = list.split('"').skip(1).step_by(2);
    names.map(String::from).collect()
}

/// Names and licences of all packages.
fn packages() -> Vec<(String, Option<String>)> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let output = Command::new(cargo)
        .args([
            "metadata",
            "--format-version",
            "1",
            "--all-features",
            "--locked",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("a list");
    let text = |package: &serde_json::Value, key: &str| package[key].as_str().map(String::from);
    let named = packages.iter().map(|package| {
        let name = text(package, "name").expect("a name");
        (name, text(package, "license"))
    });
    named.collect()
}

#[test]
#[ignore = "it may need the network; `.ci/run` runs it"]
fn every_dependency_has_a_licence_that_is_allowed_and_every_one_allowed_is_needed() {
    let allowed = allowed();
    let packages = packages();
    assert!(packages.len() > 100, "{} packages", packages.len());
    let mut refused = Vec::new();
    let mut needed = BTreeSet::new();
    for (name, licence) in packages {
        let Some(licence) = licence else {
            refused.push(format!("{name} has none"));
            continue;
        };
        // "A/B" is how alternatives were written before SPDX.
        let expression = Expression::parse(&licence.replace('/', " OR "));
        let expression = expression.unwrap_or_else(|error| panic!("{name}: {error}"));
        let is_allowed = |id: &spdx::LicenseReq| {
            let id = id.license.id().map(|id| id.name);
            id.is_some_and(|id| allowed.contains(id))
        };
        if !expression.evaluate(is_allowed) {
            refused.push(format!("{name}: {licence}"));
        }
        // Without this one, would it be refused?
        for one in &allowed {
            let is_allowed_without = |id: &spdx::LicenseReq| {
                is_allowed(id) && id.license.id().is_none_or(|id| id.name != one)
            };
            if !expression.evaluate(is_allowed_without) {
                needed.insert(one.clone());
            }
        }
    }
    assert!(refused.is_empty(), "not in deny.toml: {refused:#?}");
    let spare: Vec<_> = allowed.difference(&needed).collect();
    assert!(spare.is_empty(), "allowed and not needed: {spare:?}");
}

/// A list that allows less refuses: the check can fail.
#[test]
fn an_expression_is_refused_where_one_of_its_parts_is_not_allowed() {
    let allowed = allowed();
    let is_allowed = |licence: &str| {
        let expression = Expression::parse(licence).expect("an expression");
        expression.evaluate(|id| {
            let id = id.license.id().map(|id| id.name);
            id.is_some_and(|id| allowed.contains(id))
        })
    };
    assert!(is_allowed("MIT OR GPL-3.0-only"));
    assert!(!is_allowed("MIT AND GPL-3.0-only"));
    assert!(!is_allowed("MPL-2.0"));
}
