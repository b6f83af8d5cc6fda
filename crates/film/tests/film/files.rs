//! Files: what is written is what is read, and errors leave nothing behind.

use std::path::Path;

use tpb_film::{Arrays, FilmError, FilmOptions, Layout, PictureOptions, Pulse};

use super::{rendered, small_cube};

fn files_in(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

#[test]
fn npz_comes_back_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transient.npz");
    let cube = small_cube();
    assert!(cube.variance.is_some());
    let mut lit = cube.clone();
    lit.apply_pulse(Pulse::Continuous).unwrap();
    let layout = Layout::new(5, 3, None).unwrap();
    let steady = rendered::<1>(layout, FilmOptions::default(), 1).develop();
    for arrays in [cube, lit, steady] {
        arrays.write_npz(&path).unwrap();
        assert!(Arrays::read_npz(&path).unwrap() == arrays);
        assert_eq!(files_in(folder.path()), 1);
    }
}

#[test]
fn npz_has_the_documented_keys_types_and_shapes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transient.npz");
    small_cube().write_npz(&path).unwrap();
    let mut npz = zip::ZipArchive::new(std::fs::File::open(&path).unwrap()).unwrap();
    let mut found: Vec<(String, String, Vec<u64>)> = Vec::new();
    let names: Vec<String> = npz.file_names().map(|name| name.unwrap().into_owned()).collect();
    for name in names {
        let array = npyz::NpyFile::new(npz.by_name(&name).unwrap()).unwrap();
        let key = name.strip_suffix(".npy").unwrap().to_owned();
        found.push((key, array.dtype().descr(), array.shape().to_vec()));
    }
    found.sort();
    let expected: [(&str, &str, &[u64]); 7] = [
        ("after", "'<f8'", &[7, 9, 3]),
        ("before", "'<f8'", &[7, 9, 3]),
        ("opl_edges", "'<f8'", &[31]),
        ("steady", "'<f8'", &[7, 9, 3]),
        ("time_edges", "'<f8'", &[31]),
        ("transient", "'<f4'", &[7, 9, 30, 3]),
        ("variance", "'<f4'", &[7, 9, 30, 3]),
    ];
    let expected = expected.map(|(n, t, s)| (n.to_owned(), t.to_owned(), s.to_vec()));
    assert_eq!(found, expected);
    let seconds = npyz::NpyFile::new(npz.by_name("time_edges.npy").unwrap()).unwrap();
    let seconds = seconds.into_vec::<f64>().unwrap();
    assert!((seconds[0] - 1.0 / 299_792_458.0).abs() < 1e-24);
}

#[test]
fn files_that_are_no_result_are_errors_that_name_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transient.npz");
    let error = Arrays::read_npz(&path).unwrap_err();
    assert!(matches!(error, FilmError::Io { .. }), "missing: {error}");
    small_cube().write_npz(&path).unwrap();
    let good = std::fs::read(&path).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 0x40;
    for bad in [&b"not an archive"[..], &good[..good.len() / 2], &[], &flipped] {
        std::fs::write(&path, bad).unwrap();
        let error = Arrays::read_npz(&path).unwrap_err();
        assert!(matches!(error, FilmError::Format { .. }), "{error}");
        assert!(error.to_string().contains("transient.npz"), "{error}");
    }
}

#[test]
fn a_shape_beyond_all_memory_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transient.npz");
    let shape = "{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999, 999999, 3)}\n";
    let header = [&b"\x93NUMPY\x01\x00"[..], &[shape.len() as u8, 0], shape.as_bytes()].concat();
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    zip.start_file("steady.npy", zip::write::SimpleFileOptions::default()).unwrap();
    std::io::Write::write_all(&mut zip, &header).unwrap();
    zip.finish().unwrap();
    let error = Arrays::read_npz(&path).unwrap_err();
    assert!(matches!(error, FilmError::Format { .. }), "{error}");
    assert!(error.to_string().contains("steady"), "{error}");
}

#[test]
fn the_steady_exr_holds_the_steady_image() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("steady.exr");
    let cube = small_cube();
    cube.write_steady_exr(&path).unwrap();
    let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
    let layer = &image.layer_data;
    assert_eq!((layer.size.0, layer.size.1), (9, 7));
    for (name, channel) in [("R", 0), ("G", 1), ("B", 2)] {
        let found = layer.channel_data.list.iter().find(|c| c.name.eq(name)).unwrap();
        let values: Vec<f32> = found.sample_data.values_as_f32().collect();
        let expected: Vec<f32> =
            cube.steady.iter().skip(channel).step_by(3).map(|&v| v as f32).collect();
        assert_eq!(values, expected, "{name}");
    }
}

#[test]
fn unwritable_paths_are_errors_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a-file");
    std::fs::write(&file, "here").unwrap();
    let cube = small_cube();
    let options = PictureOptions::default();
    for parent in [file.clone(), folder.path().join("missing")] {
        let path = parent.join("result");
        let results = [
            cube.write_npz(&path),
            cube.write_steady_exr(&path),
            cube.write_streak(&path, &options),
            cube.write_arrival_time(&path, &options).map(|_| ()),
        ];
        for result in results {
            let message = result.unwrap_err().to_string();
            assert!(message.contains("result"), "{message}");
        }
    }
    assert!(cube.write_frames(&file, &options).is_err(), "a file where the folder should be");
    assert_eq!(files_in(folder.path()), 1);
    assert_eq!(std::fs::read(&file).unwrap(), b"here");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    use std::io::Write;
    // The kernel's own full disk, behind the same buffer as every writer's.
    let error = tpb_film::atomic_write(Path::new("/dev/full/transient.npz"), |_| Ok(()));
    assert!(error.is_err(), "a device is no folder");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transient.npz");
    let error = tpb_film::atomic_write(&path, |_| (&full).write_all(b"data")).unwrap_err();
    assert!(
        matches!(&error, FilmError::Io { source, .. }
        if source.kind() == std::io::ErrorKind::StorageFull),
        "{error}"
    );
    assert_eq!(files_in(folder.path()), 0);
}
