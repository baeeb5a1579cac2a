//! Damaged files give an error that says where, never a panic, and no more memory than the file has.

use super::read::path;
use foil2d::io::{MshError, MshMesh, MshPlace};
use proptest::prelude::*;

const SOUND: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 5 1 1 2 3\n$EndElements\n";

fn refused(from: &str, to: &str) -> MshError {
    assert!(SOUND.contains(from), "{from}");
    let text = SOUND.replacen(from, to, 1);
    match MshMesh::from_bytes(text.as_bytes()) {
        Err(error) => error,
        Ok(_) => panic!("{text} is no mesh"),
    }
}

#[test]
fn damage_is_told_with_its_line() {
    assert!(MshMesh::from_bytes(SOUND.as_bytes()).is_ok());
    let cases = [
        ("2.2 0 8", "4.0 0 8", "line 2: version 4.0"),
        (
            "2.2 0 8",
            "2.2 2 8",
            "line 2: expected 0 (text) or 1 (binary)",
        ),
        (
            "$MeshFormat",
            "$Mesh",
            "line 1: expected $MeshFormat, found `$Mesh`",
        ),
        (
            "2 1 0 0",
            "2 1 O 0",
            "line 7: expected the y of a node, found `O`",
        ),
        (
            "2 1 0 0",
            "2 1 inf 0",
            "line 7: expected a finite number, found `inf`",
        ),
        (
            "2 1 0 0",
            "-2 1 0 0",
            "line 7: expected the number of a node, found `-2`",
        ),
        (
            "\n3\n1",
            "\n4\n1",
            "line 9: expected the number of a node, found `$EndNodes`",
        ),
        ("\n3\n1", "\n2\n1", "line 8: expected $EndNodes, found `3`"),
        ("3 0 1 0", "2 0 1 0", "line 8: node 2 is there twice"),
        ("3 0 1 0", "3 0 1 7", "line 8: node 3 lies at z = 7 m"),
        (
            "1 2 3\n$End",
            "1 2 7\n$End",
            "line 12: element 1 names node 7",
        ),
        ("1 2 2 5", "1 4 2 5", "line 12: element 1 is a tetrahedron"),
        (
            "1 2 2 5",
            "1 99 2 5",
            "line 12: element 1 is a thing that is not known (gmsh's type 99)",
        ),
        (
            "1 2 3\n$EndElements\n",
            "1 2",
            "line 12: the file ends where the number of a node",
        ),
        (
            "$Elements\n",
            "$Else\n",
            "line 10: the file ends where the end of a section",
        ),
        (
            "$EndNodes\n",
            "$EndNodes\n12\n",
            "line 10: expected the mark of a section",
        ),
        (
            "2 1 0 0",
            "2 0 0 0",
            "nodes 0 and 1 both lie at (0, 0) m: merge them (in the file: node 1, node 2)",
        ),
        (
            "1 2 3\n$End",
            "1 2 2\n$End",
            "(in the file: element 1, node 2)",
        ),
    ];
    for (from, to, expected) in cases {
        let told = refused(from, to).to_string();
        assert!(told.contains(expected), "{to}: {told}");
    }
    let empty = SOUND.replace("\n1\n1 2 2 5 1 1 2 3\n", "\n0\n");
    let error = MshMesh::from_bytes(empty.as_bytes()).expect_err("no cells");
    assert!(matches!(error, MshError::NoCells), "{error}");
    let cut = &SOUND[..SOUND.find("$Elements").expect("it is there")];
    let error = MshMesh::from_bytes(cut.as_bytes()).expect_err("no elements");
    assert!(
        error.to_string().contains("no section $Elements"),
        "{error}"
    );
    let parts = SOUND.replace("$Nodes", "$ParametricNodes");
    let error = MshMesh::from_bytes(parts.as_bytes()).expect_err("not read");
    assert!(
        error
            .to_string()
            .contains("line 4: section $ParametricNodes"),
        "{error}"
    );
}

/// Binary numbers have no lines. Counts beyond the file are found out by its end, with no memory taken for them.
#[test]
fn damage_in_binary_files_is_told_with_its_byte() {
    let whole = std::fs::read(path("strip_mixed_41_little")).expect("the file is there");
    let nodes = whole
        .windows(7)
        .position(|window| window == b"$Nodes\n")
        .expect("there are nodes")
        + 7;
    let error = MshMesh::from_bytes(&whole[..nodes + 100]).expect_err("it is cut");
    let MshError::Cut {
        place: MshPlace::Byte(at),
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert!((nodes + 92..=nodes + 100).contains(&at), "{at}");
    for word in 0..2 {
        let mut huge = whole.clone();
        huge[nodes + 8 * word..nodes + 8 * word + 8].copy_from_slice(&(u64::MAX / 3).to_le_bytes());
        let found = MshMesh::from_bytes(&huge);
        // The number of nodes is only a hint, that of blocks is not.
        assert_eq!(found.is_err(), word == 0);
    }
    let mut endless = whole;
    endless[nodes + 32 + 12..nodes + 32 + 20].copy_from_slice(&(u64::MAX / 5).to_le_bytes());
    let error = MshMesh::from_bytes(&endless).expect_err("no such file is finished");
    assert!(error.to_string().contains("byte"), "{error}");
}

fn all_files() -> Vec<Vec<u8>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/msh");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be listed").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "msh"))
        .collect();
    files.sort();
    assert_eq!(files.len(), 17);
    let read = |path| std::fs::read(path).expect("it can be read");
    files.into_iter().map(read).collect()
}

/// Some change of a file: a byte, a word of eight, a piece left out, one put twice, or the end cut off.
#[derive(Clone, Debug)]
struct Change {
    kind: u8,
    at: usize,
    length: usize,
    value: u64,
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let values = prop_oneof![
        any::<u64>(),
        0u64..300,
        Just(u64::MAX),
        Just(1 << 31),
        Just(u64::from(u32::MAX)),
        Just(f64::NAN.to_bits()),
        Just(1e300f64.to_bits()),
    ];
    let change =
        (0u8..6, any::<usize>(), 1usize..80, values).prop_map(|(kind, at, length, value)| Change {
            kind,
            at,
            length,
            value,
        });
    proptest::collection::vec(change, 1..4)
}

fn apply(bytes: &mut Vec<u8>, change: &Change) {
    if bytes.is_empty() {
        return;
    }
    let at = change.at % bytes.len();
    let end = (at + change.length).min(bytes.len());
    match change.kind {
        0 => bytes[at] = change.value as u8,
        1 | 2 => {
            let width = if change.kind == 1 { 8 } else { 4 };
            let end = (at + width).min(bytes.len());
            bytes[at..end].copy_from_slice(&change.value.to_le_bytes()[..end - at]);
        }
        3 => drop(bytes.drain(at..end)),
        4 => {
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        _ => {
            let number = (change.value as i64 / 3).to_string();
            bytes.splice(at..(at + 1).min(bytes.len()), number.into_bytes());
        }
    }
}

/// `FOIL2D_FUZZ` takes the number of inputs.
fn n_cases() -> u32 {
    let asked = std::env::var("FOIL2D_FUZZ").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(4000)
}

#[test]
fn changed_files_do_no_harm() {
    let files = all_files();
    let input = (0..files.len(), changes());
    let config = ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(n_cases())
    };
    let n_read = std::cell::Cell::new([0u32; 2]);
    proptest!(config, |((file, changes) in input)| {
        let mut bytes = files[file].clone();
        changes.iter().for_each(|change| apply(&mut bytes, change));
        let [mut sound, mut damaged] = n_read.get();
        match MshMesh::pieces_from_bytes(&bytes) {
            Ok(pieces) => {
                sound += 1;
                for piece in pieces {
                    prop_assert!(piece.mesh.area() > 0.0);
                    let n_cells = piece.mesh.n_cells();
                    prop_assert!(piece.regions.iter().flat_map(|one| &one.cells).all(|&cell| cell < n_cells));
                    let n_nodes = piece.mesh.n_nodes();
                    prop_assert!(piece.boundaries.iter().flat_map(|one| &one.nodes).all(|&node| node < n_nodes));
                }
            }
            Err(error) => {
                damaged += 1;
                // Two coordinates of 1e300 are told with all their digits.
                prop_assert!(error.to_string().len() < 1000);
            }
        }
        n_read.set([sound, damaged]);
    });
    let [sound, damaged] = n_read.get();
    assert!(
        sound > n_cases() / 50 && damaged > n_cases() / 4,
        "{sound} {damaged}"
    );
}

#[test]
fn arbitrary_bytes_do_no_harm() {
    let heads = [
        "",
        "$MeshFormat\n2.2 1 8\n\u{1}\0\0\0\n$EndMeshFormat\n$Nodes\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Elements\n",
    ];
    let config = ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(n_cases() / 2)
    };
    let bytes = proptest::collection::vec(any::<u8>(), 0..300);
    proptest!(config, |(head in 0..heads.len(), bytes in bytes)| {
        let input = [heads[head].as_bytes(), &bytes].concat();
        prop_assert!(MshMesh::from_bytes(&input).is_err());
    });
}
