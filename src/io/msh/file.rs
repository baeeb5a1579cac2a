//! The sections of a file, of both versions, as they stand there.

use super::element::ElementKind;
use super::error::MshError;
use super::reader::{Encoding, Reader};
use std::collections::HashMap;

/// A node of the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) tag: u64,
    /// Coordinates (m).
    pub(super) at: [f64; 3],
    /// Byte at which it stands.
    pub(super) offset: usize,
}

/// An element of the file; its nodes are `File::element_nodes[first_node..]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub(super) tag: u64,
    pub(super) kind: ElementKind,
    pub(super) group: Group,
    pub(super) first_node: usize,
    pub(super) n_nodes: usize,
    pub(super) offset: usize,
}

/// How an element says which physical group it is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Group {
    /// By the group's number, none if zero (version 2).
    Physical(i64),
    /// By the dimension and the number of its piece of geometry (version 4).
    Entity(i64, i64),
}

/// All that is read of a file.
#[derive(Debug, Default)]
pub(super) struct File {
    /// Names of groups, by dimension and number.
    pub(super) names: HashMap<(i64, i64), String>,
    /// Groups of pieces of geometry, by dimension and number.
    pub(super) entities: HashMap<(i64, i64), Vec<i64>>,
    pub(super) nodes: Vec<Node>,
    pub(super) elements: Vec<Element>,
    pub(super) element_nodes: Vec<u64>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

/// Fewest bytes of a number as text: a digit, and white space before it.
const TEXT_BYTES: usize = 2;

impl File {
    /// Reads all sections.
    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, MshError> {
        let version = read_header(reader)?;
        let mut file = Self::default();
        let (mut has_nodes, mut has_elements) = (false, false);
        while let Some((start, name)) = reader.word() {
            match (name, version) {
                (b"$PhysicalNames", _) => file.read_names(reader)?,
                (b"$Entities", Version::Four) => file.read_entities(reader)?,
                (b"$PartitionedEntities", _) => {
                    return Err(MshError::UnsupportedSection {
                        place: reader.place(start),
                        section: "$PartitionedEntities",
                        cure: "write the mesh without partitions (gmsh -part 0)",
                    });
                }
                (b"$ParametricNodes", _) => {
                    return Err(MshError::UnsupportedSection {
                        place: reader.place(start),
                        section: "$ParametricNodes",
                        cure: "set Mesh.SaveParametric to 0",
                    });
                }
                (b"$Nodes", _) => {
                    has_nodes = true;
                    match version {
                        Version::Two => file.read_nodes_2(reader)?,
                        Version::Four => file.read_nodes_4(reader)?,
                    }
                }
                (b"$Elements", _) => {
                    has_elements = true;
                    match version {
                        Version::Two => file.read_elements_2(reader)?,
                        Version::Four => file.read_elements_4(reader)?,
                    }
                }
                _ if name.starts_with(b"$") => reader.skip_section(name)?,
                _ => {
                    let expected = "the mark of a section, such as $Nodes";
                    return Err(reader.unexpected(start, expected, name));
                }
            }
        }
        match (has_nodes, has_elements) {
            (false, _) => Err(MshError::MissingSection { section: "$Nodes" }),
            (_, false) => Err(MshError::MissingSection {
                section: "$Elements",
            }),
            _ => Ok(file),
        }
    }

    /// Lines of dimension, number and name in quotes.
    fn read_names(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        let n_names: u64 = reader.text("a number of names")?;
        for _ in 0..n_names {
            let dimension = reader.text("the dimension of a group")?;
            let tag = reader.text("the number of a group")?;
            let (start, line) = (reader.offset(), reader.line());
            let quoted = line.trim_ascii();
            let bare = quoted
                .strip_prefix(b"\"")
                .and_then(|rest| rest.strip_suffix(b"\""));
            let name = bare.and_then(|name| std::str::from_utf8(name).ok());
            let expected = "a name in double quotes, in UTF-8";
            let name = name.ok_or_else(|| reader.unexpected(start, expected, quoted))?;
            self.names.insert((dimension, tag), name.to_owned());
        }
        reader.end_of("$EndPhysicalNames")
    }

    /// Pieces of geometry with their groups; where they are and what bounds them is not kept.
    fn read_entities(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        begin_binary(reader)?;
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = reader.size("a number of pieces of geometry")?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = reader.integer("the number of a piece of geometry")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    reader.real("a coordinate")?;
                }
                let n_groups = reader.size("a number of groups")?;
                let mut groups = Vec::new();
                for _ in 0..n_groups {
                    // negative where the group turns it round
                    groups.push(reader.integer("the number of a group")?.saturating_abs());
                }
                if dimension > 0 {
                    let n_bounding = reader.size("a number of bounding pieces")?;
                    for _ in 0..n_bounding {
                        reader.integer("the number of a bounding piece")?;
                    }
                }
                self.entities.insert((dimension, tag), groups);
            }
        }
        reader.end_of("$EndEntities")
    }

    fn read_nodes_2(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        let n_nodes: u64 = reader.text("a number of nodes")?;
        begin_binary(reader)?;
        self.nodes.reserve(reader.room_for(n_nodes, 4 * TEXT_BYTES));
        for _ in 0..n_nodes {
            let tag = positive(reader, "the number of a node")?;
            let (offset, at) = point(reader)?;
            self.nodes.push(Node { tag, at, offset });
        }
        reader.end_of("$EndNodes")
    }

    fn read_nodes_4(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        begin_binary(reader)?;
        let n_blocks = reader.size("a number of blocks")?;
        let n_nodes = reader.size("a number of nodes")?;
        reader.size("the smallest number of a node")?;
        reader.size("the largest number of a node")?;
        self.nodes.reserve(reader.room_for(n_nodes, 4 * TEXT_BYTES));
        let mut tags = Vec::new();
        for _ in 0..n_blocks {
            let dimension = reader.integer("a dimension")?;
            reader.integer("the number of a piece of geometry")?;
            let is_parametric = reader.integer("0 or 1")? != 0;
            let n_in_block = reader.size("a number of nodes")?;
            tags.clear();
            for _ in 0..n_in_block {
                tags.push(reader.size("the number of a node")?);
            }
            let n_parameters = if is_parametric {
                dimension.clamp(0, 3)
            } else {
                0
            };
            for &tag in &tags {
                let (offset, at) = point(reader)?;
                for _ in 0..n_parameters {
                    reader.real("a parameter of a node")?;
                }
                self.nodes.push(Node { tag, at, offset });
            }
        }
        reader.end_of("$EndNodes")
    }

    /// One element a line, or binary blocks of elements with the same type and number of tags.
    fn read_elements_2(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        let mut n_left: u64 = reader.text("a number of elements")?;
        begin_binary(reader)?;
        let is_text = reader.encoding == Encoding::Ascii;
        while n_left > 0 {
            let offset = reader.start();
            let tag_before = if is_text {
                positive(reader, "the number of an element")?
            } else {
                0
            };
            let kind = reader.integer("the type of an element")?;
            let n_in_block = if is_text {
                1
            } else {
                positive(reader, "a number of elements")?
            };
            let n_tags = positive(reader, "a number of tags")?;
            if n_in_block == 0 || n_in_block > n_left {
                let found = n_in_block.to_string();
                let expected = "a block of as many elements as are left, or fewer";
                return Err(reader.unexpected(offset, expected, found.as_bytes()));
            }
            for _ in 0..n_in_block {
                let offset = if is_text { offset } else { reader.offset() };
                let tag = if is_text {
                    tag_before
                } else {
                    positive(reader, "the number of an element")?
                };
                let mut group = 0;
                for index in 0..n_tags {
                    let value = reader.integer("a tag of an element")?;
                    if index == 0 {
                        group = value.saturating_abs();
                    }
                }
                self.read_element(reader, (kind, tag), Group::Physical(group), offset)?;
            }
            n_left -= n_in_block;
        }
        reader.end_of("$EndElements")
    }

    fn read_elements_4(&mut self, reader: &mut Reader<'_>) -> Result<(), MshError> {
        begin_binary(reader)?;
        let n_blocks = reader.size("a number of blocks")?;
        let n_elements = reader.size("a number of elements")?;
        reader.size("the smallest number of an element")?;
        reader.size("the largest number of an element")?;
        self.elements
            .reserve(reader.room_for(n_elements, 2 * TEXT_BYTES));
        for _ in 0..n_blocks {
            let dimension = reader.integer("a dimension")?;
            let entity = reader.integer("the number of a piece of geometry")?;
            let kind = reader.integer("the type of an element")?;
            let n_in_block = reader.size("a number of elements")?;
            for _ in 0..n_in_block {
                let offset = reader.start();
                let tag = reader.size("the number of an element")?;
                let group = Group::Entity(dimension, entity);
                self.read_element(reader, (kind, tag), group, offset)?;
            }
        }
        reader.end_of("$EndElements")
    }

    /// The nodes of an element.
    fn read_element(
        &mut self,
        reader: &mut Reader<'_>,
        (number, tag): (i64, u64),
        group: Group,
        offset: usize,
    ) -> Result<(), MshError> {
        let kind = ElementKind::of(number);
        let n_nodes = match kind {
            ElementKind::Cell(cell) => cell.n_nodes(),
            ElementKind::Part { n_nodes, .. } => n_nodes,
            ElementKind::Other(name, cure) => {
                return Err(MshError::UnsupportedElement {
                    place: reader.place(reader.offset()),
                    tag,
                    name,
                    kind: number,
                    cure,
                });
            }
        };
        let first_node = self.element_nodes.len();
        for _ in 0..n_nodes {
            self.element_nodes
                .push(reader.size_or_integer(group, "the number of a node")?);
        }
        self.elements.push(Element {
            tag,
            kind,
            group,
            first_node,
            n_nodes,
            offset,
        });
        Ok(())
    }
}

impl Reader<'_> {
    /// Numbers of nodes are `i32` in binary files of version 2 and sizes in those of version 4.
    fn size_or_integer(&mut self, group: Group, expected: &'static str) -> Result<u64, MshError> {
        match group {
            Group::Physical(_) => positive(self, expected),
            Group::Entity(..) => self.size(expected),
        }
    }
}

/// `$MeshFormat`: the version, and how numbers are written from here on.
fn read_header(reader: &mut Reader<'_>) -> Result<Version, MshError> {
    reader.end_of("$MeshFormat")?;
    let version: String = reader.text("the version of the format")?;
    let version = match version.as_str() {
        "2.2" => Version::Two,
        "4.1" => Version::Four,
        other => {
            let version = other.chars().take(20).collect();
            return Err(MshError::Version { version });
        }
    };
    let start = reader.start();
    let kind: u64 = reader.text("0 (text) or 1 (binary)")?;
    let size_bytes: usize = reader.text("the size of a number (4 or 8)")?;
    if kind > 1 || ![4, 8].contains(&size_bytes) {
        let found = format!("{kind} {size_bytes}");
        let expected = "0 (text) or 1 (binary), and the size of a number, 4 or 8";
        return Err(reader.unexpected(start, expected, found.as_bytes()));
    }
    if kind == 1 {
        reader.line();
        let start = reader.offset();
        reader.encoding = Encoding::Binary {
            is_big_endian: false,
            size_bytes,
        };
        let one = reader.integer("the number 1, which shows the order of bytes")?;
        let is_big_endian = one == i64::from(1i32.swap_bytes());
        if one != 1 && !is_big_endian {
            let expected = "the number 1, which shows the order of bytes";
            return Err(reader.unexpected(start, expected, one.to_string().as_bytes()));
        }
        reader.encoding = Encoding::Binary {
            is_big_endian,
            size_bytes,
        };
    }
    reader.end_of("$EndMeshFormat")?;
    Ok(version)
}

/// Goes to the line behind a word, where binary numbers begin.
fn begin_binary(reader: &mut Reader<'_>) -> Result<(), MshError> {
    if reader.encoding == Encoding::Ascii {
        return Ok(());
    }
    let start = reader.offset();
    match reader.line().trim_ascii() {
        [] => Ok(()),
        rest => Err(reader.unexpected(start, "the end of the line", rest)),
    }
}

/// A number that is not negative.
fn positive(reader: &mut Reader<'_>, expected: &'static str) -> Result<u64, MshError> {
    let start = reader.start();
    let value = reader.integer(expected)?;
    u64::try_from(value)
        .map_err(|_| reader.unexpected(start, expected, value.to_string().as_bytes()))
}

/// Three coordinates (m), with the byte where they stand.
fn point(reader: &mut Reader<'_>) -> Result<(usize, [f64; 3]), MshError> {
    let mut at = [0.0; 3];
    at[0] = reader.real("the x of a node")?;
    let offset = reader.offset();
    at[1] = reader.real("the y of a node")?;
    at[2] = reader.real("the z of a node")?;
    Ok((offset, at))
}
