//! Which file of a crate imports which: the arrows of `docs/architecture.md`, read from the
//! sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::Visit;
use syn::{Attribute, File, Item, ItemMod, ItemUse, UseTree, Visibility};

/// A module, as its path from the crate's root; the root is empty.
pub type Module = Vec<String>;

/// Longest chain of re-exports that a name is followed through.
const MAX_RE_EXPORTS: usize = 8;

/// The files of a crate and what each imports from the others.
///
/// A name that a module only hands on (`pub use`) counts for the file that defines it. Tests are
/// left out.
#[derive(Debug)]
pub struct Imports {
    arrows: BTreeMap<Module, BTreeSet<Module>>,
}

impl Imports {
    /// Reads all sources below `folder`, a crate's `src`.
    ///
    /// # Panics
    /// If a source cannot be read or is not Rust.
    #[must_use]
    pub fn of_crate(folder: &Path) -> Self {
        let mut sources = BTreeMap::new();
        read_sources(folder, &Vec::new(), &mut sources);
        let modules: BTreeSet<Module> = sources.keys().cloned().collect();
        let re_exports =
            sources.iter().map(|(module, (_, names))| (module.clone(), names.re_exports.clone())).collect();
        let reader = Resolver { modules: &modules, re_exports: &re_exports };
        let mut arrows = BTreeMap::new();
        for (module, (is_folder, names)) in &sources {
            let targets = names.paths.iter().filter_map(|path| reader.definition(module, path));
            // A folder's face hands on what is below it.
            let is_own = |target: &Module| target == module || (*is_folder && target.starts_with(module));
            arrows.insert(module.clone(), targets.filter(|target| !is_own(target)).collect());
        }
        Self { arrows }
    }

    /// Groups of files that import each other in a loop, each with its modules.
    #[must_use]
    pub fn circles(&self) -> Vec<Vec<Module>> {
        let reached: BTreeMap<&Module, BTreeSet<&Module>> =
            self.arrows.keys().map(|module| (module, self.reached_from(module))).collect();
        let mut circles: Vec<Vec<Module>> = Vec::new();
        for (module, targets) in &reached {
            if targets.contains(module) && !circles.iter().any(|circle| circle.contains(module)) {
                let returns = |other: &&&Module| reached[**other].contains(module);
                circles.push(targets.iter().filter(returns).map(|&other| other.clone()).collect());
            }
        }
        circles
    }

    /// Arrows between the modules at the crate's root, by name.
    #[must_use]
    pub fn between_rooms(&self) -> BTreeMap<String, BTreeSet<String>> {
        let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (module, targets) in &self.arrows {
            let Some(room) = module.first() else { continue };
            let others = targets.iter().filter_map(|target| target.first()).filter(|other| *other != room);
            rooms.entry(room.clone()).or_default().extend(others.cloned());
        }
        rooms
    }

    fn reached_from(&self, module: &Module) -> BTreeSet<&Module> {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&Module> = self.arrows.get(module).into_iter().flatten().collect();
        while let Some(next) = open.pop() {
            if reached.insert(next) {
                open.extend(self.arrows.get(next).into_iter().flatten());
            }
        }
        reached
    }
}

/// Names that a source takes from elsewhere in its crate.
#[derive(Debug, Default)]
struct Names {
    paths: BTreeSet<Vec<String>>,
    re_exports: BTreeMap<String, Vec<String>>,
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let is_public = !matches!(item.vis, Visibility::Inherited);
        let mut leaves = Vec::new();
        list_leaves(&item.tree, &mut Vec::new(), &mut leaves);
        for (name, path) in leaves {
            if is_public {
                self.re_exports.insert(name, path.clone());
            }
            self.paths.insert(path);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if matches!(parts[0].as_str(), "crate" | "super" | "self") && parts.len() > 1 {
            self.paths.insert(parts);
        }
        syn::visit::visit_path(self, path);
    }

    fn visit_item(&mut self, item: &'ast Item) {
        if !is_test(attributes(item)) {
            syn::visit::visit_item(self, item);
        }
    }
}

struct Resolver<'a> {
    modules: &'a BTreeSet<Module>,
    re_exports: &'a BTreeMap<Module, BTreeMap<String, Vec<String>>>,
}

impl Resolver<'_> {
    /// The module whose file defines what `path` names when `module` says it; `None` if another
    /// crate does.
    fn definition(&self, module: &Module, path: &[String]) -> Option<Module> {
        let (mut base, mut rest) = self.start(module, path)?;
        for _ in 0..MAX_RE_EXPORTS {
            while let Some((first, others)) = rest.split_first() {
                let inner: Module = base.iter().chain([first]).cloned().collect();
                if !self.modules.contains(&inner) {
                    break;
                }
                (base, rest) = (inner, others.to_vec());
            }
            let Some(handed_on) = rest.first().and_then(|name| self.re_exports.get(&base)?.get(name)) else { break };
            let (next, start) = self.start(&base, handed_on)?;
            (base, rest) = (next, start.into_iter().chain(rest.into_iter().skip(1)).collect());
        }
        Some(base)
    }

    fn start(&self, module: &Module, path: &[String]) -> Option<(Module, Vec<String>)> {
        let ups = path.iter().take_while(|part| *part == "super").count();
        match path.first()?.as_str() {
            "crate" => Some((Vec::new(), path[1..].to_vec())),
            "super" => Some((module[..module.len().checked_sub(ups)?].to_vec(), path[ups..].to_vec())),
            "self" => Some((module.clone(), path[1..].to_vec())),
            first => {
                let inner: Module = module.iter().cloned().chain([first.to_owned()]).collect();
                self.modules.contains(&inner).then(|| (module.clone(), path.to_vec()))
            }
        }
    }
}

/// Reads the sources below `folder`, which is `module`; a name is kept with whether its file is a
/// folder's face.
fn read_sources(folder: &Path, module: &Module, sources: &mut BTreeMap<Module, (bool, Names)>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the folder can be read").path();
        let stem = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        let inner: Module = module.iter().cloned().chain([stem.clone()]).collect();
        if path.is_dir() {
            read_sources(&path, &inner, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") && stem != "main" {
            let is_face = matches!(stem.as_str(), "mod" | "lib");
            let text = fs::read_to_string(&path).expect("the source can be read");
            let file: File = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let mut names = Names::default();
            names.visit_file(&file);
            sources.insert(if is_face { module.clone() } else { inner }, (is_face, names));
        }
    }
}

fn list_leaves(tree: &UseTree, path: &mut Vec<String>, leaves: &mut Vec<(String, Vec<String>)>) {
    let mut leaf = |name: String, last: Option<String>| {
        leaves.push((name, path.iter().cloned().chain(last).collect()));
    };
    match tree {
        UseTree::Name(name) => leaf(name.ident.to_string(), Some(name.ident.to_string())),
        UseTree::Rename(name) => leaf(name.rename.to_string(), Some(name.ident.to_string())),
        UseTree::Glob(_) => leaf("*".to_owned(), None),
        UseTree::Path(inner) => {
            path.push(inner.ident.to_string());
            list_leaves(&inner.tree, path, leaves);
            path.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|item| list_leaves(item, path, leaves)),
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    let is_cfg_test = |attribute: &Attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|word| word == "test")
    };
    attributes.iter().any(is_cfg_test)
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Mod(ItemMod { attrs, .. }) | Item::Use(ItemUse { attrs, .. }) => attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => &[],
    }
}
