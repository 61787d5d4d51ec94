//! The folder of a run: what it is called, who may write to it, and how it never holds half a file.

use super::RunRecord;
use crate::models::SeriesRow;
use serde::Serialize;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Files that a run makes beside its record and its scene; removed when it starts anew.
const PRODUCTS: [&str; 7] =
    ["bodies.csv", "series.csv", "tablets.csv", "panels.csv", "coating.vtp", "bed.png", "report.html"];

/// The folder of a run, held by this process alone.
#[derive(Debug)]
pub struct RunDir {
    path: PathBuf,
    /// Locked while the folder is in use; the system lets go when the process ends.
    _lock: File,
}

/// Why a run folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RunDirError {
    /// It holds something else.
    #[error("{} holds the run of another scene; give another --out, or remove it", .0.display())]
    OtherScene(PathBuf),
    /// Another process writes to it.
    #[error("{} is in use by another run; give another --out", .0.display())]
    InUse(PathBuf),
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A table cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: csv::Error,
    },
}

impl RunDir {
    /// Makes the folder for a new run of the scene `text`, stores it as `scene.ron` and removes the products of an
    /// earlier run of the same scene.
    ///
    /// # Errors
    /// [`RunDirError::OtherScene`] when the folder holds the run of another scene, which is left untouched;
    /// [`RunDirError::InUse`]; [`RunDirError::Write`].
    pub fn create(path: &Path, text: &str) -> Result<Self, RunDirError> {
        let fault = |path: &Path, source| RunDirError::Write { path: path.to_owned(), source };
        fs::create_dir_all(path).map_err(|source| fault(path, source))?;
        let directory = Self::lock(path)?;
        let scene = path.join("scene.ron");
        let held = [scene.clone(), path.join("run.json")].iter().any(|file| file.exists());
        if held && fs::read(&scene).ok().as_deref() != Some(text.as_bytes()) {
            return Err(RunDirError::OtherScene(path.to_owned()));
        }
        directory.write("scene.ron", text.as_bytes())?;
        for product in PRODUCTS.map(|name| path.join(name)) {
            match fs::remove_file(&product) {
                Err(source) if source.kind() != io::ErrorKind::NotFound => {
                    return Err(fault(&product, source));
                }
                _ => {}
            }
        }
        Ok(directory)
    }

    /// Opens the folder of a run for reading it and adding to it.
    ///
    /// # Errors
    /// [`RunDirError::InUse`], [`RunDirError::Read`] when there is no such folder.
    pub fn open(path: &Path) -> Result<Self, RunDirError> {
        fs::metadata(path.join("run.json"))
            .map_err(|source| RunDirError::Read { path: path.join("run.json"), source })?;
        Self::lock(path)
    }

    fn lock(path: &Path) -> Result<Self, RunDirError> {
        let file = path.join(".lock");
        let lock = File::create(&file).map_err(|source| RunDirError::Write { path: file.clone(), source })?;
        match lock.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), _lock: lock }),
            Err(TryLockError::WouldBlock) => Err(RunDirError::InUse(path.to_owned())),
            Err(TryLockError::Error(source)) => Err(RunDirError::Write { path: file, source }),
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file as a whole: whoever reads it sees the old one or the new one.
    ///
    /// # Errors
    /// [`RunDirError::Write`].
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), RunDirError> {
        let (path, partial) = (self.path.join(name), self.path.join(format!(".{name}.part")));
        let write = || {
            let mut file = File::create(&partial)?;
            file.write_all(content)?;
            file.sync_all()?;
            fs::rename(&partial, &path)
        };
        write().map_err(|source| RunDirError::Write { path: path.clone(), source })
    }

    /// Writes `run.json`.
    ///
    /// # Errors
    /// [`RunDirError::Write`].
    pub fn write_record(&self, record: &RunRecord) -> Result<(), RunDirError> {
        let mut json = serde_json::to_string_pretty(record)
            .map_err(|fault| RunDirError::Write { path: self.path.join("run.json"), source: fault.into() })?;
        json.push('\n');
        self.write("run.json", json.as_bytes())
    }

    /// Writes a table, a row per item; field names are the columns.
    ///
    /// # Errors
    /// [`RunDirError::Write`], [`RunDirError::Table`].
    pub fn write_table<R: Serialize>(
        &self,
        name: &str,
        rows: impl IntoIterator<Item = R>,
    ) -> Result<(), RunDirError> {
        let fault = |source| RunDirError::Table { path: self.path.join(name), source };
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row).map_err(fault)?;
        }
        let bytes = writer.into_inner().map_err(|broken| fault(broken.into_error().into()))?;
        self.write(name, &bytes)
    }

    /// Starts `series.csv`.
    ///
    /// # Errors
    /// [`RunDirError::Table`].
    pub fn series(&self) -> Result<SeriesFile, RunDirError> {
        let path = self.path.join("series.csv");
        match csv::Writer::from_path(&path) {
            Ok(writer) => Ok(SeriesFile { path, writer }),
            Err(source) => Err(RunDirError::Table { path, source }),
        }
    }
}

/// `series.csv`, every row on the disk as soon as it is known.
#[derive(Debug)]
pub struct SeriesFile {
    path: PathBuf,
    writer: csv::Writer<File>,
}

impl SeriesFile {
    /// Adds a row.
    ///
    /// # Errors
    /// [`RunDirError::Table`].
    pub fn add(&mut self, row: &SeriesRow) -> Result<(), RunDirError> {
        let added = self.writer.serialize(row).and_then(|()| Ok(self.writer.flush()?));
        added.map_err(|source| RunDirError::Table { path: self.path.clone(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tables::TabletRow;

    fn names(path: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(path).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn rows<R: serde::de::DeserializeOwned>(dir: &RunDir, name: &str) -> Vec<R> {
        csv::Reader::from_path(dir.path().join(name)).unwrap().deserialize().map(Result::unwrap).collect()
    }

    #[test]
    fn the_run_of_another_scene_is_left_untouched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs/a");
        let first = RunDir::create(&path, "(one)").unwrap();
        first.write("report.html", b"result").unwrap();
        drop(first);
        let refused = RunDir::create(&path, "(two)").unwrap_err();
        assert!(matches!(refused, RunDirError::OtherScene(_)));
        assert_eq!(fs::read(path.join("report.html")).unwrap(), b"result");
        assert_eq!(fs::read(path.join("scene.ron")).unwrap(), b"(one)");
        // The same scene starts anew, without the old products.
        RunDir::create(&path, "(one)").unwrap();
        assert_eq!(names(&path), [".lock", "scene.ron"]);
    }

    #[test]
    fn two_runs_do_not_share_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let _first = RunDir::create(folder.path(), "()").unwrap();
        assert!(matches!(RunDir::create(folder.path(), "()"), Err(RunDirError::InUse(_))));
    }

    #[test]
    fn tables_and_series_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let dir = RunDir::create(folder.path(), "()").unwrap();
        let row = TabletRow {
            tablet: 3,
            shape: "a, \"b\"".into(),
            mass_mg: 1300.0,
            coat_mass_mg: 0.1,
            mean_thickness_um: 1e-3,
            cov_intra: None,
            cap_to_band: None,
        };
        dir.write_table("tablets.csv", [&row]).unwrap();
        assert_eq!(rows::<TabletRow>(&dir, "tablets.csv"), [row]);
        let row = SeriesRow {
            time_s: 0.5,
            cov_intra: 2.0,
            cov_intra_each: None,
            cov_intra_average_tablet: 1.0,
            cov_total: 3.0,
            cov_inter: 2.5,
            sd_cov_intra: Some(0.1),
            mean_thickness_um: 0.02,
        };
        let mut series = dir.series().unwrap();
        series.add(&row).unwrap();
        // On the disk before the file is closed.
        assert_eq!(rows::<SeriesRow>(&dir, "series.csv"), [row]);
        let header = "time_s,cov_intra,cov_intra_each,cov_intra_average_tablet,cov_total,cov_inter,sd_cov_intra,\
                      mean_thickness_um\n";
        assert!(fs::read_to_string(dir.path().join("series.csv")).unwrap().starts_with(header));
    }
}
