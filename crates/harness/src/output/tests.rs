use super::*;
use std::fs;

fn text(text: &str) -> impl FnOnce(&mut BufWriter<&File>) -> io::Result<()> {
    move |out| writeln!(out, "{text}")
}

#[test]
fn a_failure_leaves_what_was_there() -> io::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("out.csv");
    write_whole(&path, text("first"))?;
    let failed = write_whole(&path, |out| {
        writeln!(out, "second")?;
        Err(io::Error::other("no more"))
    });
    assert_eq!(failed.unwrap_err().to_string(), "no more");
    assert_eq!(fs::read_to_string(&path)?, "first\n");
    assert_eq!(fs::read_dir(folder.path())?.count(), 1, "the temporary file is gone");
    Ok(())
}

#[test]
fn long_names_have_room() -> io::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("x".repeat(255));
    write_whole(&path, text("there"))?;
    assert_eq!(fs::read_to_string(path)?, "there\n");
    Ok(())
}

#[test]
fn who_claims_a_file_is_alone_with_it() -> Result<(), ClaimError> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("record.json");
    let first = Claim::of(&path)?;
    assert!(matches!(Claim::of(&path), Err(ClaimError::Taken)));
    Claim::of(&folder.path().join("other.json"))?;
    drop(first);
    drop(Claim::of(&path)?);
    assert_eq!(fs::read_dir(folder.path())?.count(), 0, "no lock is left over");
    Ok(())
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};

    #[test]
    fn a_link_is_followed_and_stays() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("elsewhere"))?;
        fs::write(at("elsewhere/file"), "old")?;
        symlink("elsewhere/file", at("link"))?;
        symlink("elsewhere/new", at("dangling"))?;
        for (link, file) in [("link", "elsewhere/file"), ("dangling", "elsewhere/new")] {
            check(&at(link))?;
            write_whole(&at(link), text("new"))?;
            assert!(fs::symlink_metadata(at(link))?.is_symlink());
            assert_eq!(fs::read_to_string(at(file))?, "new\n");
        }
        symlink("round", at("round"))?;
        assert!(write_whole(&at("round"), text("never")).is_err());
        Ok(())
    }

    #[test]
    fn the_mode_of_a_file_is_kept() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("secret");
        fs::write(&path, "old")?;
        for mode in [0o600, 0o640] {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode))?;
            write_whole(&path, text("new"))?;
            assert_eq!(fs::metadata(&path)?.permissions().mode() & 0o7777, mode);
        }
        Ok(())
    }

    #[test]
    fn a_pipe_gets_what_is_written_and_stays_a_pipe() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("pipe");
        rustix::fs::mkfifoat(rustix::fs::CWD, &path, rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR)?;
        check(&path)?;
        let reader = std::thread::spawn({
            let path = path.clone();
            move || fs::read_to_string(path)
        });
        write_whole(&path, text("through"))?;
        assert_eq!(reader.join().unwrap()?, "through\n");
        assert!(fs::symlink_metadata(&path)?.file_type().is_fifo());
        Ok(())
    }

    #[test]
    fn devices_stay_devices() -> io::Result<()> {
        write_whole(Path::new("/dev/null"), text("gone"))?;
        assert!(fs::metadata("/dev/null")?.file_type().is_char_device());
        Ok(())
    }

    #[test]
    fn files_among_devices_are_files() -> io::Result<()> {
        // Systems without it have nothing to be tested here.
        let Ok(folder) = tempfile::tempdir_in("/dev/shm") else { return Ok(()) };
        let path = folder.path().join("out");
        write_whole(&path, text("longer than what replaces it"))?;
        write_whole(&path, text("short"))?;
        assert_eq!(fs::read_to_string(&path)?, "short\n");
        Ok(())
    }

    #[test]
    fn a_planted_link_is_not_written_through() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("out");
        fs::write(folder.path().join("victim"), "mine")?;
        symlink("victim", folder.path().join(format!("out.{}.part", std::process::id())))?;
        write_whole(&path, text("new"))?;
        assert_eq!(fs::read_to_string(folder.path().join("victim"))?, "mine");
        Ok(())
    }
}

#[test]
fn a_place_that_can_not_be_written_is_told_before() -> io::Result<()> {
    let folder = tempfile::tempdir()?;
    assert!(check(&folder.path().join("none/out")).is_err());
    assert!(check(folder.path()).is_err(), "a folder is no file");
    check(&folder.path().join("out"))?;
    assert_eq!(fs::read_dir(folder.path())?.count(), 0);
    Ok(())
}
