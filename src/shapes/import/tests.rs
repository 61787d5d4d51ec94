use super::{read_closed_mesh, read_surface};
use crate::shapes::{ClosedMesh, ImportedSurface, MassProperties, Repair};
use std::fmt::Write;
use std::path::PathBuf;

/// Corners of a 2 × 3 × 4 block, in mm, and its facets, wound outwards.
const CORNERS: [[f64; 3]; 8] = [
    [0., 0., 0.],
    [2., 0., 0.],
    [2., 3., 0.],
    [0., 3., 0.],
    [0., 0., 4.],
    [2., 0., 4.],
    [2., 3., 4.],
    [0., 3., 4.],
];
const FACETS: [[usize; 3]; 12] = [
    [0, 2, 1],
    [0, 3, 2],
    [4, 5, 6],
    [4, 6, 7],
    [0, 1, 5],
    [0, 5, 4],
    [1, 2, 6],
    [1, 6, 5],
    [2, 3, 7],
    [2, 7, 6],
    [3, 0, 4],
    [3, 4, 7],
];

type Facet = [[f64; 3]; 3];

fn block() -> Vec<Facet> {
    FACETS.iter().map(|f| f.map(|v| CORNERS[v])).collect()
}

fn ascii_stl(facets: &[Facet]) -> Vec<u8> {
    let mut text = "solid block\n".to_owned();
    for facet in facets {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in facet {
            writeln!(text, "vertex {x} {y} {z}").expect("written");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid block\n").into_bytes()
}

fn binary_stl(facets: &[Facet], announced: u32) -> Vec<u8> {
    let mut bytes = b"solid is how this binary begins".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(announced.to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|&x| (x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn obj() -> Vec<u8> {
    let mut text = "# a block\no block\nvn 0 0 1\n".to_owned();
    for [x, y, z] in CORNERS {
        writeln!(text, "v {x} {y} {z}").expect("written");
    }
    // The six sides as quadrilaterals; the last by numbers from the end.
    (text + "f 1 4 3 2\nf 5//1 6//1 7//1 8//1\nf 1/1/1 2/1/1 6/1/1 5/1/1\nf 2 3 7 6\nf 3 4 8 7\nf -5 -8 -4 -1\n")
        .into_bytes()
}

fn ply(format: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\ncomment a block\nelement vertex 8\nproperty float x\nproperty double y\n\
         property float z\nproperty uchar red\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    let big = format == "binary_big_endian";
    let mut push = |mut value: Vec<u8>| {
        if big {
            value.reverse();
        }
        bytes.extend(value);
    };
    if format == "ascii" {
        for [x, y, z] in CORNERS {
            push(format!("{x} {y} {z} 255\n").into_bytes());
        }
        for [a, b, c] in FACETS {
            push(format!("3 {a} {b} {c}\n").into_bytes());
        }
        return bytes;
    }
    for [x, y, z] in CORNERS {
        push((x as f32).to_le_bytes().to_vec());
        push(y.to_le_bytes().to_vec());
        push((z as f32).to_le_bytes().to_vec());
        push(vec![255]);
    }
    for facet in FACETS {
        push(vec![3]);
        for v in facet {
            push((v as u32).to_le_bytes().to_vec());
        }
    }
    bytes
}

/// What reading a file in mm gives: the mesh, or the message without the path.
fn read_as<T, E: std::fmt::Display>(
    name: &str,
    content: &[u8],
    read: impl Fn(&std::path::Path, f64) -> Result<T, E>,
) -> Result<T, String> {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, content).expect("written");
    read(&path, 1e-3).map_err(|e| e.to_string().replace(&path.display().to_string(), ""))
}

fn read(name: &str, content: &[u8]) -> Result<ClosedMesh, String> {
    read_as(name, content, read_closed_mesh)
}

fn stl(facets: &[Facet]) -> Result<ClosedMesh, String> {
    read("block.stl", &ascii_stl(facets))
}

fn surface(facets: &[Facet]) -> Result<ImportedSurface, String> {
    read_as("plate.stl", &ascii_stl(facets), read_surface)
}

fn volume(mesh: &ClosedMesh) -> f64 {
    MassProperties::of_polyhedron(&mesh.vertices, &mesh.triangles).volume * 1e9
}

#[test]
fn every_format_gives_the_same_block() {
    for (name, content) in [
        ("block.stl", ascii_stl(&block())),
        ("block.STL", binary_stl(&block(), 12)),
        ("block.obj", obj()),
        ("block.ply", ply("ascii")),
        ("block.ply", ply("binary_little_endian")),
        ("block.ply", ply("binary_big_endian")),
    ] {
        let mesh = read(name, &content).unwrap_or_else(|fault| panic!("{name}{fault}"));
        assert_eq!((mesh.vertices.len(), mesh.triangles.len(), mesh.repairs.len()), (8, 12, 0), "{name}");
        assert!((volume(&mesh) - 24.0).abs() < 1e-6, "{name}");
    }
}

#[test]
fn repairs_are_made_and_told() {
    let mut turned = block();
    turned[4].swap(0, 1);
    turned[7].swap(0, 1);
    let mut inside_out = block();
    for facet in &mut inside_out {
        facet.swap(0, 1);
    }
    let mut with_point = block();
    with_point.insert(2, [CORNERS[0], CORNERS[0], CORNERS[1]]);
    // Facet 1 of the block split at a point of its edge 0-2, which facet 2 does not know: a straight facet fills the gap.
    let mut straight = block();
    let middle = [1.0, 1.5, 0.0];
    straight.splice(0..1, [[CORNERS[0], middle, CORNERS[1]], [middle, CORNERS[2], CORNERS[1]]]);
    straight.push([CORNERS[0], CORNERS[2], middle]);
    for (facets, repair, triangles) in [
        (turned, Repair::Turned { count: 2, first: 5 }, 12),
        (inside_out, Repair::InsideOut, 12),
        (with_point, Repair::Dropped { count: 1, first: 3 }, 12),
        (straight, Repair::Straight { count: 1, first: 14 }, 14),
    ] {
        let mesh = stl(&facets).unwrap_or_else(|fault| panic!("{repair}: {fault}"));
        assert_eq!((mesh.repairs.clone(), mesh.triangles.len()), (vec![repair], triangles));
        assert!((volume(&mesh) - 24.0).abs() < 1e-6, "{repair}");
    }
}

#[test]
fn vertices_that_differ_by_rounding_are_welded() {
    let mut facets = block();
    for (k, p) in facets.iter_mut().flatten().enumerate() {
        p[0] += 1e-6 * (k % 3) as f64;
    }
    let mesh = stl(&facets).expect("closed");
    assert_eq!(mesh.vertices.len(), 8);
    let [Repair::Welded { count, most_um }] = mesh.repairs[..] else { panic!("{:?}", mesh.repairs) };
    assert!(count > 10 && (1e-3..3e-3).contains(&most_um), "{count} {most_um}");
}

#[test]
fn faults_of_the_surface_name_a_facet() {
    let shifted = |by: [f64; 3]| {
        block().into_iter().map(move |f| f.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]))
    };
    let mut nan = block();
    nan[5][1][2] = f64::NAN;
    let mut dented = block();
    // Corner 6 pulled out through the opposite side.
    dented.iter_mut().flatten().filter(|p| **p == CORNERS[6]).for_each(|p| *p = [-1.0, 1.0, 2.0]);
    // Top and bottom pressed in so far that they meet in the middle.
    let mut dimpled = block()[4..].to_vec();
    for [u, v] in [[4, 5], [5, 6], [6, 7], [7, 4], [0, 3], [3, 2], [2, 1], [1, 0]] {
        dimpled.push([CORNERS[u], CORNERS[v], [1.0, 1.5, 2.0]]);
    }
    let scaled = |by: f64| block().into_iter().map(move |f| f.map(|p| p.map(|x| x * by))).collect::<Vec<_>>();
    let cases: Vec<(Vec<Facet>, &str)> = vec![
        (Vec::new(), "there is no facet in the file"),
        (nan, "facet 6 has a coordinate that is not a finite number"),
        (scaled(1000.0), "it would be 4 m across, expected 0.0005 to 0.1 m"),
        (scaled(0.001), "it would be 0.000004 m across"),
        (
            block()[..11].to_vec(),
            "the surface is open: 3 edges have a facet on one side only, the first is of facet",
        ),
        (
            block().into_iter().chain([block()[0]]).collect(),
            "3 edges have more than two facets, the first is of facet 1",
        ),
        (block().into_iter().chain(shifted([9., 0., 0.])).collect(), "there are 2 separate surfaces"),
        (dimpled, "the surface touches itself in a corner of facet"),
        (dented, "cross each other"),
    ];
    for (facets, message) in cases {
        let fault = stl(&facets).expect_err(message);
        assert!(fault.contains(message), "{fault}");
    }
}

#[test]
fn faults_of_the_file_name_a_line_or_count() {
    let text = String::from_utf8(ascii_stl(&block())).expect("text");
    let half = text.lines().take(40).map(|l| l.to_owned() + "\n").collect::<String>();
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("b.stl", half.into_bytes(), ":40: the file ends without `endsolid`"),
        ("b.stl", text.replacen("vertex 2 3 0", "vertex 2 3 O", 1).into_bytes(), ":5: `O` is not a number"),
        (
            "b.stl",
            text.replacen("vertex 2 3 0", "vertex 2 3", 1).into_bytes(),
            ":5: expected three coordinates",
        ),
        ("b.stl", text.replacen("vertex 2 3 0\n", "", 1).into_bytes(), ":7: a facet has three vertices"),
        (
            "b.stl",
            binary_stl(&block(), 4_000_000_000),
            ": the header announces 4000000000 facets, the file has room for 12",
        ),
        (
            "b.stl",
            binary_stl(&block(), 12)[..600].to_vec(),
            ": the header announces 12 facets, the file has room for 10",
        ),
        ("b.stl", vec![0; 10], ": the header announces 0 facets, the file has room for 0"),
        (
            "b.step",
            text.clone().into_bytes(),
            ": the format is not known by its name; expected .stl, .obj or .ply",
        ),
        ("b.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n".to_vec(), ": facet 1 names vertex 3, but there are 2"),
        ("b.obj", b"v 0 0 0\nf 1 x 1\n".to_vec(), ":2: `x` is not a vertex number"),
        ("b.obj", b"v 0 0 0\nf 1 1\n".to_vec(), ":2: a face has at least three vertices"),
        ("b.ply", b"plain text".to_vec(), ":1: no `end_header`"),
        (
            "b.ply",
            b"ply\nelement vertex many\nend_header\n".to_vec(),
            ":2: `element vertex many` is not a line of a PLY",
        ),
        ("b.ply", ply("binary_little_endian")[..300].to_vec(), ": the file ends before vertex 6 of 8"),
        (
            "b.ply",
            String::from_utf8(ply("ascii"))
                .expect("text")
                .replace("face 12", "face 999999999999")
                .into_bytes(),
            ": the file ends before face 13 of 999999999999",
        ),
        (
            "b.ply",
            String::from_utf8(ply("ascii")).expect("text").replace("3 0 2 1", "3 0 9 1").into_bytes(),
            ": facet 1 names vertex 9, but there are 8",
        ),
    ];
    for (name, content, message) in cases {
        let fault = read(name, &content).expect_err(message);
        assert!(fault.starts_with(message), "{fault} / {message}");
    }
}

#[test]
fn a_drum_may_be_open_but_not_wound_both_ways() {
    let mesh =
        surface(&block().into_iter().map(|f| f.map(|p| p.map(|x| 10.0 * x))).take(4).collect::<Vec<_>>());
    assert_eq!(mesh.expect("two plates").mesh.triangles.len(), 4);
    let mut plates: Vec<Facet> = block()[..4].iter().map(|f| f.map(|p| p.map(|x| 10.0 * x))).collect();
    plates[3].swap(0, 1);
    assert!(
        surface(&plates).expect_err("wound both ways").contains("facet 4 is wound against its neighbour")
    );
}
