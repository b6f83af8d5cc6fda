//! Files of ours and of other programs, whole and broken.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use tpb_film::archive::{ArchiveWriter, Compression};

use super::*;
use crate::testing::{cube, with_error};

/// A `.npy` file, byte by byte: format version 1.0.
fn npy(kind: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}");
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(data);
    bytes
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::File::create(&path).unwrap().write_all(bytes).unwrap();
    path
}

fn error(path: &Path) -> String {
    load(path).unwrap_err().to_string()
}

#[test]
fn any_byte_order_size_and_memory_order_gives_the_same_cube() {
    let folder = tempfile::tempdir().unwrap();
    // (2, 3, 4, 1) with cell = its index in C order.
    let values: Vec<f64> = (0..24).map(f64::from).collect();
    let mut fortran = Vec::new();
    for t in 0..4 {
        for x in 0..3 {
            for y in 0..2 {
                fortran.push(values[(y * 3 + x) * 4 + t]);
            }
        }
    }
    let single =
        |v: &[f64]| -> Vec<u8> { v.iter().flat_map(|&v| (v as f32).to_le_bytes()).collect() };
    let big = |v: &[f64]| -> Vec<u8> { v.iter().flat_map(|v| v.to_be_bytes()).collect() };
    let files = [
        npy("<f4", false, "(2, 3, 4)", &single(&values)),
        npy("<f4", false, "(2, 3, 4, 1)", &single(&values)),
        npy(">f8", false, "(2, 3, 4)", &big(&values)),
        npy("<f4", true, "(2, 3, 4)", &single(&fortran)),
        npy(">f8", true, "(2, 3, 4, 1)", &big(&fortran)),
    ];
    for (index, bytes) in files.iter().enumerate() {
        let loaded = load(&write(folder.path(), &format!("{index}.npy"), bytes)).unwrap();
        let arrays = &loaded.arrays;
        assert_eq!((arrays.height, arrays.width, arrays.bins, arrays.channels), (2, 3, 4, 1));
        let found: Vec<f64> = arrays.transient.iter().map(|&v| f64::from(v)).collect();
        assert_eq!(found, values, "file {index}");
        assert_eq!(arrays.steady[1], 4.0 + 5.0 + 6.0 + 7.0);
        assert!(!loaded.timed && loaded.is_sound() && loaded.remarks.is_empty());
    }
}

/// Regression: integers and half floats were refused, such as edges by `np.arange`.
#[test]
fn numbers_of_all_types_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let values = [0.0, 1.0, 7.0, 120.0];
    let little: [(&str, Vec<u8>); 11] = [
        ("|b1", [[0], [1], [1], [1]].concat()),
        ("|u1", values.map(|v| [v as u8]).concat()),
        ("|i1", values.map(|v| (v as i8).to_le_bytes()).concat()),
        ("<u2", values.map(|v| (v as u16).to_le_bytes()).concat()),
        ("<i2", values.map(|v| (v as i16).to_le_bytes()).concat()),
        ("<u4", values.map(|v| (v as u32).to_le_bytes()).concat()),
        ("<i4", values.map(|v| (v as i32).to_le_bytes()).concat()),
        ("<u8", values.map(|v| (v as u64).to_le_bytes()).concat()),
        ("<i8", values.map(|v| (v as i64).to_le_bytes()).concat()),
        ("<f2", values.map(|v| half::f16::from_f64(v).to_le_bytes()).concat()),
        ("<f8", values.map(f64::to_le_bytes).concat()),
    ];
    for (kind, data) in little {
        let expected = if kind == "|b1" { [0.0, 1.0, 1.0, 1.0] } else { values };
        let big = kind.replace('<', ">");
        let size = data.len() / 4;
        let swapped: Vec<u8> = data.chunks(size).flat_map(|v| v.iter().rev().copied()).collect();
        for (kind, data) in [(kind, &data), (&big, &swapped)] {
            let path = write(folder.path(), "a.npy", &npy(kind, false, "(1, 2, 2)", data));
            let found = load(&path).unwrap().arrays.transient.clone();
            assert_eq!(found, expected.map(|v| v as f32), "{kind}");
        }
    }
    let below = [-1_i16, -300].map(i16::to_le_bytes).concat();
    let path = write(folder.path(), "a.npy", &npy("<i2", false, "(1, 1, 2)", &below));
    assert_eq!(load(&path).unwrap().arrays.transient, [-1.0, -300.0]);
    // An archive of several members, edges counted by integers.
    let cells = npy("<f4", false, "(1, 1, 2)", &[0; 8]);
    let edges = npy("<i8", false, "(3,)", &[4_i64, 5, 6].map(i64::to_le_bytes).concat());
    let batches = npy("<i8", false, "()", &9_i64.to_le_bytes());
    let variance = npy("<f2", false, "(1, 1, 2)", &[0; 4]);
    let members = [
        ("transient", &cells),
        ("opl_edges", &edges),
        ("batches", &batches),
        ("variance", &variance),
    ];
    let path = packed(folder.path(), "a.npz", &members);
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.arrays.opl_edges, [4.0, 5.0, 6.0]);
    assert_eq!((loaded.batches, loaded.timed), (Some(9), true));
    let none = npy("<i8", false, "()", &0_i64.to_le_bytes());
    let path = packed(folder.path(), "a.npz", &[("transient", &cells), ("batches", &none)]);
    assert!(error(&path).contains("`batches`"));
}

/// An archive of arrays that are files already.
fn packed(folder: &Path, name: &str, members: &[(&str, &Vec<u8>)]) -> PathBuf {
    let path = folder.join(name);
    let mut writer = zip::ZipWriter::new(fs::File::create(&path).unwrap());
    for (name, bytes) in members {
        let options = zip::write::SimpleFileOptions::default();
        writer.start_file(format!("{name}.npy"), options).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap();
    path
}

#[test]
fn masks_say_which_pixels_count() {
    let folder = tempfile::tempdir().unwrap();
    let arrays = cube(3, 2, 4, 1);
    let of = |name: &str, bytes: &[u8]| load_mask(&write(folder.path(), name, bytes), &arrays);
    let expected = [true, false, true, true, false, false];
    let flags = npy("|b1", false, "(2, 3)", &[1, 0, 1, 1, 0, 0]);
    assert_eq!(of("mask.npy", &flags).unwrap(), expected);
    let floats = [0.5_f32, 0.0, -1.0, f32::INFINITY, 0.0, 0.0].map(f32::to_le_bytes).concat();
    assert_eq!(of("mask.npy", &npy("<f4", false, "(2, 3)", &floats)).unwrap(), expected);
    let other = npy("|u1", false, "(1,)", &[3]);
    for members in [&[("only", &flags)][..], &[("mask", &flags), ("other", &other)]] {
        assert_eq!(load_mask(&packed(folder.path(), "m.npz", members), &arrays).unwrap(), expected);
    }
    let two = packed(folder.path(), "m.npz", &[("a", &flags), ("b", &flags)]);
    let told = |mask: Result<Vec<bool>, ViewerError>| mask.unwrap_err().to_string();
    assert!(told(load_mask(&two, &arrays)).contains("no array `mask`"));
    let turned = told(of("mask.npy", &npy("|b1", false, "(3, 2)", &[1; 6])));
    assert!(turned.contains("(3, 2)") && turned.contains("(2, 3)"), "{turned}");
    assert!(told(of("mask.npy", &npy("|b1", false, "(2, 3)", &[0; 6]))).contains("no pixel"));
    // Regression: NaN counted as 1.
    let odd = [1.0_f32, 0.0, 1.0, 0.0, f32::NAN, 0.0].map(f32::to_le_bytes).concat();
    let odd = told(of("mask.npy", &npy("<f4", false, "(2, 3)", &odd)));
    assert!(odd.contains("mask.npy") && odd.contains("row 1, column 1"), "{odd}");
    assert!(told(of("mask.npy", &npy("|b1", false, "(6,)", &[1; 6]))).contains("(rows, columns)"));
}

/// Regression: our steady image, of all time, was compared with the sum of another program's bins.
#[test]
fn steady_images_are_of_the_window_where_no_more_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let ours = folder.path().join("ours.npz");
    let arrays = cube(2, 1, 3, 1);
    arrays.write_npz(&ours).unwrap();
    let cells: Vec<u8> = arrays.transient.iter().flat_map(|v| v.to_le_bytes()).collect();
    let bare = write(folder.path(), "bare.npy", &npy("<f4", false, "(1, 2, 3)", &cells));
    for order in [[&ours, &bare], [&bare, &ours]] {
        let mut both = order.map(|path| load(path).unwrap());
        bring_together(&mut both.each_mut()).unwrap();
        let [a, b] = &both;
        assert_eq!(a.arrays.steady, b.arrays.steady);
        let whole = if order[0] == &ours { a } else { b };
        assert!(whole.window_only && whole.arrays.before == [0.0; 2]);
        assert!(whole.remarks[0].contains("outside the window"), "{:?}", whole.remarks);
    }
    // Among our own, light of all time is compared.
    let mut both = [load(&ours).unwrap(), load(&ours).unwrap()];
    bring_together(&mut both.each_mut()).unwrap();
    assert!(both.iter().all(|loaded| loaded.arrays == arrays && loaded.remarks.is_empty()));

    // Radiances of different instants do not add up.
    let path =
        packed(folder.path(), "on.npz", &[("radiance", &npy("<f4", false, "(1, 2, 3)", &cells))]);
    let [.., last] = arrays.pixel(1) else { panic!("three bins") };
    assert_eq!(load(&path).unwrap().arrays.steady[1], f64::from(*last));
}

#[test]
fn broken_files_are_errors_that_name_them() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| error(&write(folder.path(), name, bytes));
    for (kind, size) in [("<c8", 8), ("<f16", 16), ("|S4", 4), ("<M8[s]", 8)] {
        let message = file("odd.npy", &npy(kind, false, "(2, 2, 2)", &vec![0; 8 * size]));
        let told = message.contains("odd.npy") && message.contains("at most 64 bits");
        assert!(told, "{kind}: {message}");
    }
    assert!(file("short.npy", &npy("<f4", false, "(2, 2, 2)", &[0; 31])).contains("shorter"));
    let huge = "(4294967295, 4294967295, 4294967295)";
    assert!(file("huge.npy", &npy("<f4", false, huge, &[0; 32])).contains("shorter"));
    assert!(file("long.npy", &npy("<f4", false, "(1, 1, 2)", &[0; 12])).contains("longer"));
    assert!(file("flat.npy", &npy("<f4", false, "(2, 2)", &[0; 16])).contains("[2, 2]"));
    let four = npy("<f4", false, "(1, 1, 2, 4)", &[0; 32]);
    assert!(file("four.npy", &four).contains("1 or 3 channels"));
    assert!(file("empty.npy", &npy("<f4", false, "(0, 1, 2)", &[])).contains("at least one"));
    let whole = npy("<f4", false, "(1, 1, 2)", &[0; 8]);
    assert!(file("cut.npy", &whole[..40]).contains("cut.npy"));
    assert!(file("text.npy", b"no array").contains("neither"));
    assert!(file("cut.npz", b"PK\x03\x04 and nothing").contains("cut.npz"));
    assert!(error(&folder.path().join("nowhere.npy")).contains("nowhere.npy"));
    assert!(error(folder.path()).contains("transient.npz"));
}

/// Regression: `steady` made an archive ours, and a damaged member was no array at all.
#[test]
fn a_steady_image_alone_makes_no_archive_ours_and_damage_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let singles = |count: usize| [1.0_f32.to_le_bytes()].concat().repeat(count);
    let steady = npy("<f4", false, "(2, 2, 3)", &singles(12));
    let sums = npy("<f4", false, "(2, 2)", &singles(4));
    for members in [&[("steady", &steady)][..], &[("steady", &steady), ("sums", &sums)]] {
        let message = error(&packed(folder.path(), "other.npz", members));
        assert!(message.contains("has no cube among its arrays (steady"), "{message}");
    }
    // A cube beside it is found, by any name, and its unit is not known.
    let cube_of = npy("<f4", false, "(2, 2, 5)", &singles(20));
    let path = packed(folder.path(), "other.npz", &[("data", &cube_of), ("steady", &steady)]);
    let loaded = load(&path).unwrap();
    assert_eq!((loaded.arrays.bins, loaded.unit_known), (5, false));
    // Ours, with and without a time axis.
    let ours = folder.path().join("ours.npz");
    let mut arrays = cube(2, 2, 3, 1);
    for _ in 0..2 {
        arrays.write_npz(&ours).unwrap();
        let loaded = load(&ours).unwrap();
        assert!(loaded.arrays == arrays && loaded.unit_known);
        (arrays.bins, arrays.opl_edges) = (0, Vec::new());
        (arrays.transient, arrays.before, arrays.after) = (Vec::new(), Vec::new(), Vec::new());
    }

    let damaged = b"\x93NUMPY\x01\x00\x10\x00no header at all".to_vec();
    let message = error(&packed(folder.path(), "odd.npz", &[("a", &damaged), ("sums", &sums)]));
    assert!(message.contains("odd.npz: `a` cannot be read"), "{message}");
    // Not needed where there is a whole cube.
    let both = packed(folder.path(), "odd.npz", &[("a", &damaged), ("data", &cube_of)]);
    assert_eq!(load(&both).unwrap().arrays.bins, 5);
}

#[test]
fn odd_cells_are_kept_and_said() {
    let folder = tempfile::tempdir().unwrap();
    let values = [1.0, -2.0, f32::NAN, f32::INFINITY];
    let data: Vec<u8> = values.iter().flat_map(|v: &f32| v.to_le_bytes()).collect();
    let path = write(folder.path(), "odd.npy", &npy("<f4", false, "(1, 1, 4)", &data));
    let loaded = load(&path).unwrap();
    let remarks = loaded.remarks.join("\n");
    assert!(
        remarks.contains("2 of 4 cells are not finite") && remarks.contains("1 of 4"),
        "{remarks}"
    );
    assert!(!loaded.is_sound());
    assert_eq!(loaded.arrays.transient[1], -2.0);
}

fn archive(path: &Path, members: &[(&str, &[usize], &[f64])]) {
    let mut writer = ArchiveWriter::new(fs::File::create(path).unwrap(), Compression::Deflated);
    for (name, shape, values) in members {
        writer.put(name, shape, values).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn archives_of_ours_and_of_others() {
    let folder = tempfile::tempdir().unwrap();
    let ours = with_error(cube(3, 2, 4, 3), 0.1);
    ours.write_npz(&folder.path().join("transient.npz")).unwrap();
    let loaded = load(folder.path()).unwrap();
    assert!(loaded.timed && loaded.arrays == ours);

    let path = folder.path().join("other.npz");
    let cells = [0.0, 1.0, 2.0, 3.0];
    let edges: Vec<f64> = (0..5).map(|i| f64::from(i) * 1e-9).collect();
    archive(&path, &[("data", &[1, 1, 4], &cells), ("time_edges", &[5], &edges)]);
    let other = load(&path).unwrap();
    assert!(other.timed && other.arrays.steady == [6.0]);
    assert!((other.arrays.opl_edges[4] - 4.0 * 0.299_792_458).abs() < 1e-12);

    archive(&path, &[("a", &[1, 1, 4], &cells), ("b", &[1, 1, 4], &cells)]);
    assert!(error(&path).contains("several cubes (a, b)"));
    archive(&path, &[("a", &[4], &cells)]);
    assert!(error(&path).contains("no cube among its arrays (a)"));
    archive(&path, &[("a", &[1, 1, 4], &cells), ("time_edges", &[4], &cells)]);
    assert!(error(&path).contains("5 edges"));
    archive(&path, &[("transient", &[1, 1, 4], &cells), ("variance", &[1, 1, 2], &cells[..2])]);
    assert!(error(&path).contains("variance"));
    // As many cells, in other places.
    archive(&path, &[("transient", &[1, 2, 2], &cells), ("variance", &[2, 1, 2], &cells)]);
    assert!(error(&path).contains("not the shape"));
}

#[test]
fn cubes_without_a_time_axis_take_that_of_others() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ours.npz");
    cube(2, 1, 3, 1).write_npz(&path).unwrap();
    let bare = write(folder.path(), "bare.npy", &npy("<f4", false, "(1, 2, 3)", &[0; 24]));
    let mut both = [load(&bare).unwrap(), load(&path).unwrap()];
    assert!(bring_together(&mut both.each_mut()).unwrap());
    assert_eq!(both[0].arrays.opl_edges, both[1].arrays.opl_edges);
    assert!(both[0].remarks[0].contains("ours.npz"));
    let mut alone = [load(&bare).unwrap(), load(&bare).unwrap()];
    assert!(!bring_together(&mut alone.each_mut()).unwrap());
    assert_eq!(alone[0].arrays.opl_edges, [0.0, 1.0, 2.0, 3.0]);

    let wide = write(folder.path(), "wide.npy", &npy("<f4", false, "(1, 1, 6)", &[0; 24]));
    let mut wrong = [load(&wide).unwrap(), load(&path).unwrap()];
    let message = bring_together(&mut wrong.each_mut()).unwrap_err().to_string();
    for part in ["wide.npy has (1, 1, 6, 1)", "ours.npz has (1, 2, 3, 1)"] {
        assert!(message.contains(part), "{part} is missing in {message}");
    }
}
