//! `coating.vtp`: the coated surface for ParaView, and for the map of a report made later.
//!
//! VTK XML PolyData in ASCII, one piece per shape, points in mm. Cell arrays, one value per panel in the order of
//! `panels.csv`: `average_um`, `area_mm2`, `cap` (1 on a cap, 0 on the band), and a `NAME_um` for each of the map's others.
//! Source of the format: VTK File Formats, "PolyData", <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

use super::ThicknessMap;
use std::fmt::Write;

/// Why a file is not one of ours.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("piece {piece} of the VTP file: {fault}")]
pub struct VtpError {
    /// Which shape, from 0.
    pub piece: usize,
    /// What is missing or wrong.
    pub fault: String,
}

/// The text of a VTP file.
pub fn write(maps: &[ThicknessMap]) -> String {
    let mut pieces = String::new();
    for map in maps {
        let cells = map.triangles.len();
        let points = list(map.vertices_mm.iter().flatten());
        let corners = list(map.triangles.iter().flatten());
        let offsets = list((1..=cells).map(|k| 3 * k));
        let caps = list(map.on_cap.iter().map(|&cap| u8::from(cap)));
        let mut arrays = array("Float64", "average_um", &list(&map.average_um))
            + &array("Float64", "area_mm2", &list(&map.areas_mm2))
            + &array("UInt8", "cap", &caps);
        for (name, thickness) in &map.others {
            arrays += &array("Float64", &format!("{name}_um"), &list(thickness));
        }
        let _ = write!(
            pieces,
            "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{cells}\">\n\
             <Points>\n<DataArray type=\"Float64\" Name=\"points\" NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray>\n</Points>\n\
             <Polys>\n{}{}</Polys>\n<CellData Scalars=\"average_um\">\n{arrays}</CellData>\n</Piece>\n",
            map.vertices_mm.len(),
            array("Int32", "connectivity", &corners),
            array("Int32", "offsets", &offsets),
        );
    }
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n\
         {pieces}</PolyData>\n</VTKFile>\n"
    )
}

/// Reads the maps of a file written by [`write()`].
///
/// # Errors
/// [`VtpError`] names the array that is missing or does not fit.
pub fn read(text: &str) -> Result<Vec<ThicknessMap>, VtpError> {
    text.split("<Piece").skip(1).enumerate().map(|(piece, text)| read_piece(piece, text)).collect()
}

fn read_piece(piece: usize, text: &str) -> Result<ThicknessMap, VtpError> {
    let fault = |fault: String| VtpError { piece, fault };
    let array = |name: &str| -> Result<Vec<f64>, VtpError> {
        let start =
            text.find(&format!("Name=\"{name}\"")).ok_or_else(|| fault(format!("no array {name}")))?;
        let body = text[start..].split_once('>').and_then(|(_, rest)| rest.split_once("</DataArray>"));
        let (numbers, _) = body.ok_or_else(|| fault(format!("array {name} does not end")))?;
        let parse = |n: &str| n.parse().map_err(|_| fault(format!("\"{n}\" in array {name} is no number")));
        numbers.split_whitespace().map(parse).collect()
    };
    // `Name="x_um"` for every thickness but the average.
    let names = text.split("Name=\"").filter_map(|t| t.split_once('"')?.0.strip_suffix("_um"));
    let others =
        names.filter(|name| *name != "average").map(|name| Ok((name.into(), array(&format!("{name}_um"))?)));
    let map = ThicknessMap {
        vertices_mm: array("points")?.as_chunks().0.to_vec(),
        triangles: array("connectivity")?
            .as_chunks()
            .0
            .iter()
            .map(|t: &[f64; 3]| t.map(|k| k as u32))
            .collect(),
        areas_mm2: array("area_mm2")?,
        on_cap: array("cap")?.into_iter().map(|cap| cap != 0.0).collect(),
        average_um: array("average_um")?,
        others: others.collect::<Result<_, _>>()?,
    };
    let cells = map.triangles.len();
    let lists =
        [("area_mm2", map.areas_mm2.len()), ("cap", map.on_cap.len()), ("average_um", map.average_um.len())];
    let others = map.others.iter().map(|(name, values)| (name.as_str(), values.len()));
    if let Some((name, found)) = lists.into_iter().chain(others).find(|(_, found)| *found != cells) {
        return Err(fault(format!("array {name} has {found} values for {cells} panels")));
    }
    match map.triangles.iter().flatten().find(|&&corner| corner as usize >= map.vertices_mm.len()) {
        Some(corner) => Err(fault(format!("a panel names point {corner} of {}", map.vertices_mm.len()))),
        None => Ok(map),
    }
}

fn array(kind: &str, name: &str, numbers: &str) -> String {
    format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{numbers}</DataArray>\n")
}

fn list<N: std::fmt::Display>(numbers: impl IntoIterator<Item = N>) -> String {
    numbers.into_iter().map(|n| n.to_string()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn tetrahedron() -> ThicknessMap {
        ThicknessMap {
            vertices_mm: vec![[0.0, 0.0, 0.1], [1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            areas_mm2: vec![0.75, 0.5, 0.5, 1.0 / 3.0],
            on_cap: vec![true, false, false, true],
            average_um: vec![1.0, 2.5, 0.1, 62.0],
            others: [("most_uniform".to_string(), vec![0.5; 4])].into(),
        }
    }

    #[test]
    fn what_is_written_is_read_back_exactly() {
        let map = tetrahedron();
        let maps = vec![map.clone(), ThicknessMap { others: BTreeMap::new(), ..map }];
        assert_eq!(read(&write(&maps)), Ok(maps));
    }

    #[test]
    fn a_broken_file_says_what_is_wrong() {
        let text = write(&[tetrahedron()]);
        let fault = |text: &str| read(text).unwrap_err().to_string();
        assert!(fault(&text.replace("area_mm2", "other")).contains("no array area_mm2"));
        assert!(fault(&text.replace(">0.75 ", ">x ")).contains("\"x\" in array area_mm2 is no number"));
        assert!(fault(&text.replace(">0.75 ", ">")).contains("area_mm2 has 3 values for 4 panels"));
        assert!(fault(&text.replace(">0 2 1 ", ">0 9 1 ")).contains("point 9 of 4"));
    }
}
