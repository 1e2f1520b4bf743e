//! Paths of the files that a scene names, in a scene that another folder holds.
//!
//! In: the folder of the new scene, and that of the one that names the files. Out: their paths in the new one, with
//! slashes on every system: relative, so that both folders move together, and absolute where no relative path leads
//! there, from one drive to another.
//!
//! Law: links are followed before the folders are compared, for `..` leads up from where a link points to.

use std::path::{Path, PathBuf};

use gearcut_core::error::Refusal;

/// From one folder to the files beside the scene in another.
#[derive(Debug, Clone, Copy)]
pub(super) struct WayToFiles<'a> {
    from: &'a Path,
    to: &'a Path,
}

impl<'a> WayToFiles<'a> {
    pub(super) fn new(from: &'a Path, to: &'a Path) -> Self {
        Self { from, to }
    }

    /// Path of a file that the scene in the other folder calls `name`, under `key`.
    ///
    /// # Errors
    /// A folder whose name is no text.
    pub(super) fn path_of(&self, name: &str, key: &str) -> Result<String, Refusal> {
        if self.from == self.to || Path::new(name).is_absolute() {
            return Ok(name.to_owned());
        }
        let way = self.way();
        let Some(way) = way.to_str() else {
            return Err(Refusal::new(
                key,
                format!("the path to {name}, {}, is not UTF-8, and a scene cannot name it", way.display()),
                "give the scene a folder with a name in UTF-8, or write the mate into the folder of its driver",
            ));
        };
        let way = if cfg!(windows) { way.replace('\\', "/") } else { way.to_owned() };
        Ok(if way.is_empty() { name.to_owned() } else { format!("{}/{name}", way.trim_end_matches('/')) })
    }

    fn way(&self) -> PathBuf {
        let absolute = || std::path::absolute(shown(self.to)).unwrap_or_else(|_| self.to.to_owned());
        let [Ok(from), Ok(to)] = [self.from, self.to].map(|folder| shown(folder).canonicalize()) else {
            return absolute();
        };
        let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
        if shared == 0 {
            return absolute();
        }
        let up = from.components().skip(shared).map(|_| Path::new(".."));
        let down = to.components().skip(shared).map(|part| Path::new(part.as_os_str()));
        up.chain(down).collect()
    }
}

/// The current folder has a name as well.
fn shown(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path_of(from: &Path, to: &Path, name: &str) -> String {
        WayToFiles::new(from, to).path_of(name, "tool.shaper_cutter.profile.file").expect("a path")
    }

    #[test]
    fn the_path_leads_to_the_same_file() {
        let place = tempfile::tempdir().expect("a folder for the test");
        let folder = |name: &str| {
            let folder = place.path().join(name);
            std::fs::create_dir_all(&folder).expect("made");
            folder
        };
        let (scenes, near, far) = (folder("scenes"), folder("scenes/near"), folder("a/b"));
        std::fs::write(scenes.join("tooth.csv"), "x").expect("written");
        for (from, expected) in [(&scenes, "tooth.csv"), (&near, "../tooth.csv"), (&far, "../../scenes/tooth.csv")] {
            assert_eq!(path_of(from, &scenes, "tooth.csv"), expected);
            assert_eq!(std::fs::read_to_string(from.join(expected)).expect("it is there"), "x");
        }
        assert_eq!(path_of(&scenes, &near, "../tooth.csv"), "near/../tooth.csv");
        // A folder that is not there, and a path that is right everywhere.
        let absolute = scenes.join("tooth.csv").to_str().expect("text").replace('\\', "/");
        assert_eq!(path_of(&scenes.join("missing"), &scenes, "tooth.csv"), absolute);
        let own = scenes.join("tooth.csv");
        assert_eq!(path_of(&far, &near, own.to_str().expect("text")), own.to_str().expect("text"));
    }
}
