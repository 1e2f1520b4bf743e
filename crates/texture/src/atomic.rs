//! Files that are either complete or absent.
//!
//! In: a final path and a closure that writes the contents. Out: the file under its name, or an error that names it and
//! tells the system's reason.
//!
//! The bytes go to a temporary name in the same folder; only when all of them are written and flushed is that name
//! changed to the final one. A full disk, a failing closure or a killed run therefore never leaves half a file under a
//! name that somebody opens later.
//!
//! Road not taken: forcing every file to the disk (`fsync`) before it gets its name. Who writes many files into one
//! folder does that once for all of them, before the folder gets its name.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use crate::disk_steps::{DiskStep, about_to};
use crate::{Error, Result};

/// What the contents of a file are written to.
pub trait Sink: Write + Seek {}
impl<T: Write + Seek> Sink for T {}

/// Writes `path` completely or not at all.
///
/// The folder must exist. A file already there is replaced at the end.
///
/// # Errors
/// [`Error::Io`] with the system's reason, or with the reason that `fill` gave through [`io::Error::other`].
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>) -> Result<()> {
    write_through(path, |file| Announced { file, path }, fill)
}

/// Writes `path` with the given contents, completely or not at all.
///
/// # Errors
/// [`Error::Io`] with the system's reason.
pub fn write_bytes_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(path, |sink| sink.write_all(bytes))
}

/// A file whose writes are announced.
struct Announced<'a> {
    file: File,
    /// The final name.
    path: &'a Path,
}

impl Write for Announced<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        about_to(DiskStep::Write, self.path)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Announced<'_> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.seek(place)
    }
}

/// [`write_atomically`] with a layer between the file and its contents; the tests put a full disk there.
fn write_through<W: Sink>(
    path: &Path,
    layer: impl FnOnce(File) -> W,
    fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> Result<()> {
    let failed = |source| Error::Io { action: "cannot write", path: path.to_owned(), source };
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    about_to(DiskStep::Create, path).map_err(failed)?;
    let temporary = new_file_builder().tempfile_in(folder).map_err(failed)?;
    let mut writer = BufWriter::new(layer(temporary.as_file().try_clone().map_err(failed)?));
    fill(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    about_to(DiskStep::Rename, path).map_err(failed)?;
    temporary.persist(path).map_err(|refused| failed(refused.error))?;
    Ok(())
}

/// Names and rights of temporary files: hidden, and readable as the user's umask says (the default of the crate would
/// leave results that nobody else may read).
/// Beginning and end of the names of files that are not whole yet.
const TEMPORARY: [&str; 2] = [".gearcut-", ".part"];

/// Whether a file of this name is what a killed writer left.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY[0]) && name.ends_with(TEMPORARY[1])
}

fn new_file_builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY[0]).suffix(TEMPORARY[1]);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for `left_bytes` more.
    struct SmallDisk {
        file: File,
        left_bytes: usize,
    }

    impl Write for SmallDisk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.left_bytes == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            let written = self.file.write(&bytes[..bytes.len().min(self.left_bytes)])?;
            self.left_bytes -= written;
            Ok(written)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.file.flush()
        }
    }

    impl Seek for SmallDisk {
        fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
            self.file.seek(place)
        }
    }

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = std::fs::read_dir(folder)
            .expect("the folder was made here")
            .map(|entry| entry.expect("listed").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Full at the first byte, in the middle, and only at the last flush: the reason is told, nothing is left.
    #[test]
    fn a_full_disk_leaves_nothing_and_tells_why() {
        for left_bytes in [0, 5_000, 99_999] {
            let folder = tempfile::tempdir().expect("a folder for the test");
            let path = folder.path().join("table.csv");
            let outcome = write_through(
                &path,
                |file| SmallDisk { file, left_bytes },
                |sink| (0..1_000).try_for_each(|_| sink.write_all(&[b'x'; 100])),
            );
            let message = outcome.expect_err("the disk is too small").to_string();
            assert!(message.contains("table.csv"), "{message}");
            assert!(message.contains("no storage space"), "{message}");
            assert_eq!(names_in(folder.path()), Vec::<String>::new(), "with room for {left_bytes} bytes");
        }
    }

    #[test]
    fn a_file_that_was_there_survives_a_failure() {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("table.csv");
        write_bytes_atomically(&path, b"old").expect("there is room");
        let outcome = write_atomically(&path, |sink| {
            sink.write_all(b"new, but")?;
            Err(io::Error::other("the writer gave up"))
        });
        assert!(outcome.expect_err("it gave up").to_string().ends_with("the writer gave up"));
        assert_eq!(std::fs::read(&path).expect("still there"), b"old");
        assert_eq!(names_in(folder.path()), ["table.csv"]);
    }

    #[test]
    fn exactly_enough_room_is_enough() {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("table.csv");
        write_through(
            &path,
            |file| SmallDisk { file, left_bytes: 100_000 },
            |sink| (0..1_000).try_for_each(|_| sink.write_all(&[b'x'; 100])),
        )
        .expect("100 000 bytes fit");
        assert_eq!(std::fs::metadata(&path).expect("written").len(), 100_000);
    }

    #[cfg(unix)]
    #[test]
    fn other_people_may_read_the_results() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder for the test");
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_bytes_atomically(&ours, b"x").expect("there is room");
        std::fs::write(&plain, b"x").expect("there is room");
        let mode = |path| std::fs::metadata(path).expect("written").permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
