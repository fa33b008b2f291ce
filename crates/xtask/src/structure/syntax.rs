//! What one file says: its modules, its imports and the paths in it, without code for tests.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, UseTree};

/// A name that a `use` declaration binds; no name for `*`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// The bound name, or `None` where all names of a module come.
    pub name: Option<String>,
    /// The path as written.
    pub path: Vec<String>,
}

/// A module whose text lies in another file.
#[derive(Debug)]
pub struct Declared {
    pub name: String,
    /// From its `path` attribute.
    pub file: Option<String>,
}

/// The contents of a module.
#[derive(Debug, Default)]
pub struct Written {
    pub imports: Vec<Import>,
    /// Names of the items defined.
    pub items: BTreeSet<String>,
    pub paths: Vec<Vec<String>>,
    pub inline: Vec<(String, Written)>,
    pub declared: Vec<Declared>,
    /// Lines of the file, those of tests left out; those of inline modules count here.
    pub lines: usize,
}

/// Reads the text of a file.
///
/// # Errors
/// Where it isn't Rust.
pub fn read(text: &str) -> Result<Written, syn::Error> {
    let file = syn::parse_file(text)?;
    let mut written = Written::default();
    written.visit_file(&file);
    let tests: usize = written.take_test_lines();
    written.lines = text.lines().count().saturating_sub(tests);
    Ok(written)
}

impl Written {
    /// While reading, `lines` holds the lines of tests: of this module and of those inline.
    fn take_test_lines(&mut self) -> usize {
        let inner: usize = self.inline.iter_mut().map(|(_, inner)| inner.take_test_lines()).sum();
        std::mem::take(&mut self.lines) + inner
    }

    fn take_use(&mut self, tree: &UseTree, before: &[String]) {
        let with = |name: &dyn ToString| [before, &[name.to_string()]].concat();
        let (name, path) = match tree {
            UseTree::Path(path) => return self.take_use(&path.tree, &with(&path.ident)),
            UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.take_use(tree, before));
                return;
            }
            UseTree::Glob(_) => (None, before.to_vec()),
            UseTree::Name(name) if name.ident == "self" => (before.last().cloned(), before.to_vec()),
            UseTree::Name(name) => (Some(name.ident.to_string()), with(&name.ident)),
            UseTree::Rename(name) if name.ident == "self" => (Some(name.rename.to_string()), before.to_vec()),
            UseTree::Rename(name) => (Some(name.rename.to_string()), with(&name.ident)),
        };
        self.paths.push(path.clone());
        self.imports.push(Import { name, path });
    }

    /// Paths of two names or more among the tokens of a macro call, whose grammar is unknown.
    fn take_tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(name) => {
                    if colons != 2 {
                        self.close(&mut path);
                    }
                    path.push(name.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                other => {
                    self.close(&mut path);
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.take_tokens(group.stream());
                    }
                }
            }
        }
        self.close(&mut path);
    }

    fn close(&mut self, path: &mut Vec<String>) {
        let path = std::mem::take(path);
        if path.len() > 1 {
            self.paths.push(path);
        }
    }
}

impl<'ast> Visit<'ast> for Written {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_test(attributes(item)) {
            use syn::spanned::Spanned;
            let span = item.span();
            self.lines += span.end().line + 1 - span.start().line;
            return;
        }
        self.items.extend(defined(item));
        match item {
            Item::Mod(module) => match &module.content {
                Some((_, items)) => {
                    let mut inner = Self::default();
                    items.iter().for_each(|item| inner.visit_item(item));
                    self.inline.push((module.ident.to_string(), inner));
                }
                None => self
                    .declared
                    .push(Declared { name: module.ident.to_string(), file: path_attribute(&module.attrs) }),
            },
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_test(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if item.leading_colon.is_none() {
            self.take_use(&item.tree, &[]);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.leading_colon.is_none() {
            self.paths.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.visit_path(&call.path);
        self.take_tokens(call.tokens.clone());
    }
}

/// Whether an item is compiled for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("cfg") => {
            let condition = list.tokens.to_string();
            condition == "test" || condition.starts_with("all (test")
        }
        _ => false,
    })
}

fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(file), .. }) => Some(file.value()),
            _ => None,
        },
        _ => None,
    })
}

/// The name that an item defines.
fn defined(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Vec<String> {
        read(text).unwrap().paths.iter().map(|path| path.join("::")).collect()
    }

    #[test]
    fn imports_are_taken_apart() {
        let written = read("use a::{self, b::C as D, e::*};").unwrap();
        let found: Vec<(Option<&str>, String)> =
            written.imports.iter().map(|i| (i.name.as_deref(), i.path.join("::"))).collect();
        let expected = [(Some("a"), "a"), (Some("D"), "a::b::C"), (None, "a::e")];
        assert_eq!(found, expected.map(|(name, path)| (name, path.to_owned())));
    }

    #[test]
    fn paths_are_found_in_types_calls_patterns_and_macros() {
        let text = "fn f(x: a::X) -> Vec<b::Y> { if let c::Z = d::g::<e::W>() { m!(\"{}\", h::i(), j) } }";
        let found = paths(text);
        for path in ["a::X", "b::Y", "c::Z", "d::g", "e::W", "h::i"] {
            assert!(found.iter().any(|p| p == path), "{path} in {found:?}");
        }
    }

    #[test]
    fn code_for_tests_is_left_out() {
        let text = "#[test] fn t() { a::b() }\n#[cfg(test)] mod tests { use c::D; }\n\
                    #[cfg(all(test, unix))] fn u() { e::f() }\nimpl X { #[cfg(test)] fn g() { h::i() } }";
        assert_eq!(paths(text), ["X"]);
    }

    #[test]
    fn what_isnt_rust_is_an_error() {
        assert!(read("fn (").is_err());
    }
}
