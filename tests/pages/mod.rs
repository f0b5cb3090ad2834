//! Pages in Markdown as the tests read them: the README, and the book in `docs/src`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The languages that blocks may be in; any other tag would be Rust to rustdoc.
const LANGUAGES: [&str; 5] = ["sh", "json", "rust", "text", "python"];

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

pub fn text(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}")).replace("\r\n", "\n")
}

/// What stands in `backticks`.
pub fn quoted(words: &str) -> Vec<String> {
    words.split('`').skip(1).step_by(2).map(String::from).collect()
}

/// Runs the program in the folder of the crate; its exit code and what it said.
pub fn spinneb(arguments: &[&str]) -> (Option<i32>, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(root()).args(arguments).output().unwrap();
    (done.status.code(), String::from_utf8(done.stderr).unwrap())
}

/// Runs a config into a folder.
pub fn run(config: &Path, out: &Path) {
    let (code, said) = spinneb(&["run", config.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{said}");
}

/// A fenced block.
pub struct Block {
    pub language: String,
    pub content: String,
    /// The words since the block before it.
    before: String,
}

impl Block {
    /// The file that the paragraph before it names last.
    fn file(&self) -> Option<String> {
        let paragraph = self.before.trim_end().rsplit("\n\n").next()?;
        quoted(paragraph).into_iter().rfind(|name| name.ends_with(".json"))
    }
}

pub struct Page {
    pub file: String,
    pub text: String,
}

impl Page {
    pub fn read(file: &str) -> Page {
        Page { file: file.into(), text: text(file) }
    }

    /// The pages of the book, in the order of their names, and its table of contents.
    pub fn book() -> (Vec<Page>, Page) {
        let files = fs::read_dir(root().join("docs/src")).unwrap().map(|e| e.unwrap().file_name());
        let names: BTreeSet<String> = files.map(|name| name.into_string().unwrap()).collect();
        let page = |name: &String| Page::read(&format!("docs/src/{name}"));
        (names.iter().filter(|name| *name != "SUMMARY.md").map(page).collect(), Page::read("docs/src/SUMMARY.md"))
    }

    pub fn blocks(&self) -> Vec<Block> {
        let parts: Vec<&str> = self.text.split("```").collect();
        assert!(parts.len() % 2 == 1, "{}: a block is not closed", self.file);
        let block = |pair: &[&str]| {
            let (language, content) = pair[1].split_once('\n').unwrap();
            assert!(LANGUAGES.contains(&language), "{}: a block is tagged {language:?}", self.file);
            Block { language: language.into(), content: content.into(), before: pair[0].into() }
        };
        parts.chunks_exact(2).map(block).collect()
    }

    /// The blocks in this language.
    pub fn blocks_of(&self, language: &str) -> Vec<String> {
        self.blocks().into_iter().filter(|block| block.language == language).map(|block| block.content).collect()
    }

    /// The cells of its tables, a row each; headings and rules of the tables included.
    pub fn rows(&self) -> Vec<Vec<String>> {
        let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect();
        self.text.lines().filter(|line| line.starts_with('|')).map(cells).collect()
    }

    /// Where its links and pictures lead.
    pub fn links(&self) -> Vec<&str> {
        self.text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap()).collect()
    }

    /// The headings, as links name them.
    fn anchors(&self) -> Vec<String> {
        let headings = self.text.lines().filter_map(|line| line.strip_prefix('#'));
        let kept = |c: char| c.is_alphanumeric() || " -_".contains(c);
        let anchor = |heading: &str| {
            let words: String = heading.trim_start_matches('#').trim().chars().filter(|c| kept(*c)).collect();
            words.to_lowercase().replace(' ', "-")
        };
        headings.map(anchor).collect()
    }

    /// Fails where a link leads nowhere.
    pub fn check_links(&self) {
        let folder = root().join(&self.file).parent().unwrap().to_path_buf();
        for link in self.links().into_iter().filter(|link| !link.starts_with("https://")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { root().join(&self.file) } else { folder.join(file) };
            assert!(target.exists(), "{}: {link}", self.file);
            if !anchor.is_empty() {
                let page = Page { file: link.into(), text: fs::read_to_string(&target).unwrap() };
                assert!(page.anchors().iter().any(|own| own == anchor), "{}: {link}", self.file);
            }
        }
    }

    /// Does in a new folder what the page says: writes its JSON blocks as the files that the words before them name, runs its
    /// commands, and finds in their output what the page shows of it. How many commands that were.
    pub fn follow(&self) -> usize {
        let folder = tempfile::tempdir().unwrap();
        let (mut commands, mut output) = (0, String::new());
        for block in self.blocks().into_iter().filter(|block| !block.content.starts_with("cargo ")) {
            match block.language.as_str() {
                "json" => self.write(&block, folder.path()),
                "sh" => {
                    output = self.sh(&block.content, folder.path());
                    commands += block.content.lines().count();
                    continue;
                }
                "text" if block.before.trim().is_empty() => self.compare(&block.content, &output),
                _ => {}
            }
            output.clear();
        }
        commands
    }

    fn write(&self, block: &Block, folder: &Path) {
        let name = block.file().unwrap_or_else(|| panic!("{}: no file is named for {}", self.file, block.content));
        let used = |other: &Block| other.language != "text" && other.content.contains(&name);
        assert!(self.blocks().iter().any(used), "{}: no command uses {name}", self.file);
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, &block.content).unwrap();
    }

    fn sh(&self, commands: &str, folder: &Path) -> String {
        let program = Path::new(env!("CARGO_BIN_EXE_spinneb")).parent().unwrap();
        let usual = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([program.to_path_buf()].into_iter().chain(std::env::split_paths(&usual)));
        let mut shell = Command::new("sh");
        let done = shell.args(["-euc", commands]).env("PATH", path.unwrap()).current_dir(folder).output().unwrap();
        let said = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
        assert!(done.status.success(), "{}: {commands}\n{said}", self.file);
        said
    }

    /// Each line shown is one of the output, but for what `…` stands for.
    fn compare(&self, shown: &str, output: &str) {
        let plain = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        let lines: Vec<String> = output.lines().map(plain).collect();
        for line in shown.lines().map(plain) {
            assert!(lines.iter().any(|said| like(&line, said)), "{}: {line:?} is not in\n{output}", self.file);
        }
    }
}

/// Whether a line is this pattern, in which `…` stands for anything.
fn like(pattern: &str, line: &str) -> bool {
    let parts: Vec<&str> = pattern.split('…').collect();
    let Some(mut rest) = line.strip_prefix(parts[0]) else { return false };
    for part in &parts[1..] {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.is_empty() || parts.len() > 1 && (pattern.ends_with('…') || line.ends_with(parts[parts.len() - 1]))
}
