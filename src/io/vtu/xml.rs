//! Unstructured grids as XML, the format `.vtu` of VTK.
//!
//! Binary arrays are preceded by their length in bytes, as `u64`, and all numbers are little-endian: `header_type="UInt64"`.

use super::VtuEncoding;
use crate::io::base64::push_base64;
use std::fmt::Write as _;

/// Numbers of one array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Real(Vec<f64>),
    Integer(Vec<i64>),
    Byte(Vec<u8>),
}

/// An array with its name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    pub(super) name: &'static str,
    pub(super) n_components: usize,
    pub(super) values: Values,
}

/// Points and cells, with what is known at them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Piece {
    /// Points (m).
    pub(super) points: Vec<[f64; 2]>,
    /// Indices of the points of all cells.
    pub(super) connectivity: Vec<i64>,
    /// Ends of the cells in the connectivity.
    pub(super) offsets: Vec<i64>,
    /// VTK's types of the cells.
    pub(super) types: Vec<u8>,
    pub(super) at_points: Vec<Array>,
    pub(super) at_cells: Vec<Array>,
}

impl Array {
    /// Plane vectors, with zero for z.
    pub(super) fn vectors(name: &'static str, vectors: impl Iterator<Item = [f64; 2]>) -> Self {
        Self {
            name,
            n_components: 3,
            values: Values::Real(vectors.flat_map(|[x, y]| [x, y, 0.0]).collect()),
        }
    }

    pub(super) fn scalars(name: &'static str, scalars: Vec<f64>) -> Self {
        Self {
            name,
            n_components: 1,
            values: Values::Real(scalars),
        }
    }

    pub(super) fn integers(name: &'static str, integers: Vec<i64>) -> Self {
        Self {
            name,
            n_components: 1,
            values: Values::Integer(integers),
        }
    }
}

impl Values {
    fn type_name(&self) -> &'static str {
        match self {
            Self::Real(_) => "Float64",
            Self::Integer(_) => "Int64",
            Self::Byte(_) => "UInt8",
        }
    }

    fn push_text(&self, text: &mut String) {
        let mut push = |value: &dyn std::fmt::Debug| {
            let _ = write!(text, "{value:?} ");
        };
        match self {
            Self::Real(values) => values.iter().for_each(|value| push(value)),
            Self::Integer(values) => values.iter().for_each(|value| push(value)),
            Self::Byte(values) => values.iter().for_each(|value| push(value)),
        }
    }

    /// Length in bytes and the bytes.
    fn to_bytes(&self) -> Vec<u8> {
        let numbers: Vec<u8> = match self {
            Self::Real(values) => values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect(),
            Self::Integer(values) => values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect(),
            Self::Byte(values) => values.clone(),
        };
        let mut bytes = (numbers.len() as u64).to_le_bytes().to_vec();
        bytes.extend(numbers);
        bytes
    }
}

/// A file being written.
struct Document {
    encoding: VtuEncoding,
    text: String,
    appended: Vec<u8>,
}

/// The bytes of a file.
pub(super) fn document(pieces: &[Piece], encoding: VtuEncoding) -> Vec<u8> {
    let mut document = Document {
        encoding,
        text: String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<UnstructuredGrid>\n",
        ),
        appended: Vec::new(),
    };
    for piece in pieces {
        document.write_piece(piece);
    }
    // VTK refuses files without a piece.
    if pieces.is_empty() {
        document.write_piece(&Piece::default());
    }
    document.text.push_str("</UnstructuredGrid>\n");
    let has_appended = encoding == VtuEncoding::Appended;
    if has_appended {
        document.text.push_str("<AppendedData encoding=\"raw\">\n_");
    }
    let mut bytes = document.text.into_bytes();
    if has_appended {
        bytes.append(&mut document.appended);
        bytes.extend(b"\n</AppendedData>\n");
    }
    bytes.extend(b"</VTKFile>\n");
    bytes
}

impl Document {
    fn write_piece(&mut self, piece: &Piece) {
        let _ = writeln!(
            self.text,
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
            piece.points.len(),
            piece.types.len()
        );
        self.write_section("PointData", &piece.at_points);
        self.write_section("CellData", &piece.at_cells);
        let points = Array::vectors("Points", piece.points.iter().copied());
        self.write_section("Points", &[points]);
        let cells = [
            Array::integers("connectivity", piece.connectivity.clone()),
            Array::integers("offsets", piece.offsets.clone()),
            Array {
                name: "types",
                n_components: 1,
                values: Values::Byte(piece.types.clone()),
            },
        ];
        self.write_section("Cells", &cells);
        self.text.push_str("</Piece>\n");
    }

    fn write_section(&mut self, name: &str, arrays: &[Array]) {
        let _ = writeln!(self.text, "<{name}>");
        for array in arrays {
            self.write_array(array);
        }
        let _ = writeln!(self.text, "</{name}>");
    }

    fn write_array(&mut self, array: &Array) {
        let _ = write!(
            self.text,
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"",
            array.values.type_name(),
            array.name,
            array.n_components
        );
        // VTK's order of a symmetric tensor.
        if array.n_components == 6 {
            for (index, name) in ["XX", "YY", "ZZ", "XY", "YZ", "XZ"].iter().enumerate() {
                let _ = write!(self.text, " ComponentName{index}=\"{name}\"");
            }
        }
        match self.encoding {
            VtuEncoding::Ascii => {
                self.text.push_str(" format=\"ascii\">\n");
                array.values.push_text(&mut self.text);
            }
            VtuEncoding::Base64 => {
                self.text.push_str(" format=\"binary\">\n");
                push_base64(&mut self.text, &array.values.to_bytes());
            }
            VtuEncoding::Appended => {
                let offset = self.appended.len();
                let _ = writeln!(self.text, " format=\"appended\" offset=\"{offset}\"/>");
                self.appended.extend(array.values.to_bytes());
                return;
            }
        }
        self.text.push_str("\n</DataArray>\n");
    }
}
