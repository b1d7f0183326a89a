//! Reads the shaders as text, for mistakes that the engine does not report.
//!
//! A name that stands for an imported module must stand for nothing else. The shader's composer takes a variable of that name
//! for an item that is still to be imported: it waits for ever, and the pipeline is silently never drawn.
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Every shader of this crate.
fn shaders() -> Vec<(PathBuf, String)> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    let mut shaders = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "wgsl") {
                let wgsl = fs::read_to_string(&path).unwrap();
                shaders.push((path, wgsl));
            }
        }
    }
    shaders
}

/// What a library is imported by.
fn import_path(wgsl: &str) -> Option<&str> {
    wgsl.lines().find_map(|line| line.strip_prefix("#define_import_path ")).map(str::trim)
}

/// The names by which a shader calls those of `modules` that it imports.
fn module_names<'a>(wgsl: &'a str, modules: &[&str]) -> Vec<&'a str> {
    let imports = wgsl.lines().filter_map(|line| line.strip_prefix("#import ")).map(str::trim);
    let named = imports.map(|import| {
        let last = import.rsplit("::").next().unwrap_or(import);
        import.split_once(" as ").unwrap_or((import, last))
    });
    named.filter(|(path, _)| modules.contains(path)).map(|(_, name)| name).collect()
}

/// The places where the name of an imported module stands for something else: line and name.
fn misused(wgsl: &str, modules: &[&str]) -> Vec<(usize, String)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let names = module_names(wgsl, modules);
    let mut found = Vec::new();
    for (number, line) in wgsl.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
        let code = line.split("//").next().unwrap_or(line);
        for &name in &names {
            for (at, _) in code.match_indices(name) {
                let (before, after) = (&code[..at], &code[at + name.len()..]);
                let is_part = before.ends_with(is_word) || after.starts_with(is_word);
                let is_item = before.ends_with('.') || before.ends_with("::");
                if !is_part && !is_item && !after.starts_with("::") {
                    found.push((number + 1, name.into()));
                }
            }
        }
    }
    found
}

#[test]
fn variables_named_like_an_imported_module_are_found() {
    let wgsl = "#import lake::foam\n\
                #import lake::bed as ground\n\
                #import lake::bindings::surface\n\
                fn f(surface: f32) -> f32 {\n\
                let foam = foam::cover(surface);\n\
                let foamy = fields.foam + other::foam(ground::depth); // the foam\n\
                return foamy * ground;\n\
                }";
    let modules = ["lake::foam", "lake::bed", "lake::bindings"];
    assert_eq!(misused(wgsl, &modules), [(5, "foam".into()), (7, "ground".into())]);
    assert_eq!(misused(wgsl, &[]), []);
}

#[test]
fn no_variable_is_named_like_an_imported_module() {
    let shaders = shaders();
    let modules: Vec<&str> = shaders.iter().filter_map(|(_, wgsl)| import_path(wgsl)).collect();
    let imported: usize = shaders.iter().map(|(_, wgsl)| module_names(wgsl, &modules).len()).sum();
    assert!(shaders.len() > 25 && modules.len() > 15 && imported > 30, "they are found");
    for (path, wgsl) in &shaders {
        assert_eq!(misused(wgsl, &modules), [], "line and name in {}", path.display());
    }
}

#[test]
fn every_library_is_loaded() {
    for (path, wgsl) in shaders() {
        let plugin = fs::read_to_string(path.with_file_name("mod.rs")).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        let is_loaded = plugin.contains(&format!("load_shader_library!(app, \"{name}\")"));
        assert_eq!(is_loaded, import_path(&wgsl).is_some(), "{}", path.display());
    }
}
