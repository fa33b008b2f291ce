//! Every record keeps to `reports/record.schema.json`.

use crate::records::large;
use serde_json::{Value, json};
use std::path::Path;

/// Where `value` breaks `schema`, by the part of JSON Schema (2020-12) that the record's schema uses; any
/// other word of the language is a fault of the schema.
fn faults(root: &Value, schema: &Value, value: &Value, at: &str) -> Vec<String> {
    let mut found = Vec::new();
    let fault = |text: String| vec![format!("{at}: {text}")];
    for (word, rule) in schema.as_object().expect("a schema is an object") {
        found.extend(match word.as_str() {
            "$schema" | "$defs" | "title" | "description" => Vec::new(),
            "$ref" => {
                let path =
                    rule.as_str().and_then(|path| path.strip_prefix('#')).expect("a reference to this file");
                faults(root, root.pointer(path).unwrap_or_else(|| panic!("{path} is defined")), value, at)
            }
            "type" => {
                let names = rule.as_array().map_or_else(|| vec![rule], |names| names.iter().collect());
                let fits = names.iter().any(|name| is(value, name.as_str().expect("a type's name")));
                if fits { Vec::new() } else { fault(format!("{value} is not of type {rule}")) }
            }
            "enum" if rule.as_array().expect("a list").contains(value) => Vec::new(),
            "enum" => fault(format!("{value} is none of {rule}")),
            "minimum" if value.as_f64().is_none_or(|v| v >= rule.as_f64().expect("a number")) => Vec::new(),
            "minimum" => fault(format!("{value} is below {rule}")),
            "anyOf" => {
                let all: Vec<_> =
                    rule.as_array().expect("a list").iter().map(|one| faults(root, one, value, at)).collect();
                if all.iter().any(Vec::is_empty) { Vec::new() } else { all.concat() }
            }
            "items" => {
                let items = value.as_array().into_iter().flatten().enumerate();
                items.flat_map(|(i, item)| faults(root, rule, item, &format!("{at}/{i}"))).collect()
            }
            "required" => {
                let names = rule.as_array().expect("a list").iter().filter_map(Value::as_str);
                let absent = names.filter(|name| value.is_object() && value.get(name).is_none());
                absent.flat_map(|name| fault(format!("{name} is missing"))).collect()
            }
            "properties" => {
                let known = rule.as_object().expect("an object").iter();
                let here = known.filter_map(|(name, rule)| Some((name, rule, value.get(name)?)));
                here.flat_map(|(name, rule, part)| faults(root, rule, part, &format!("{at}/{name}")))
                    .collect()
            }
            "additionalProperties" => {
                let known = schema.get("properties").and_then(Value::as_object);
                let others = value.as_object().into_iter().flatten();
                let others = others.filter(|(name, _)| known.is_none_or(|known| !known.contains_key(*name)));
                let judge = |(name, part): (&String, &Value)| match rule {
                    Value::Bool(false) => fault(format!("{name} is not known")),
                    rule => faults(root, rule, part, &format!("{at}/{name}")),
                };
                others.flat_map(judge).collect()
            }
            other => panic!("this test does not know the word {other}"),
        });
    }
    found
}

fn is(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("there is no type {other}"),
    }
}

pub fn of_record(value: &Value) -> Vec<String> {
    let schema: Value =
        serde_json::from_str(include_str!("../../../../reports/record.schema.json")).expect("JSON");
    faults(&schema, &schema, value, "")
}

#[test]
fn records_keep_to_the_schema() {
    let mut record = large();
    record.cells[0].counters = Some([("words".to_owned(), 1.5)].into());
    record.cells[1].plan = "chosen".into();
    record.memory[0].error = Some("no room".into());
    record.cells[2].bytes = None;
    record.cells[3].check = None;
    let value = serde_json::to_value(&record).expect("JSON");
    assert_eq!(of_record(&value), [""; 0]);
}

#[test]
fn records_in_the_repository_keep_to_the_schema() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports");
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in
            std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path())
        {
            if entry.is_dir() {
                folders.push(entry);
            } else if entry.extension().is_some_and(|e| e == "json") && !entry.ends_with("record.schema.json")
            {
                let text = std::fs::read_to_string(&entry).expect("text");
                let value: Value = serde_json::from_str(&text).expect("JSON");
                // Criterion's and other tools' files are no records.
                if value.get("cells").is_some() {
                    assert_eq!(of_record(&value), [""; 0], "{}", entry.display());
                }
            }
        }
    }
}

#[test]
fn slips_are_found() {
    let sound = serde_json::to_value(large()).expect("JSON");
    let broken = |path: &str, value: Value| {
        let mut record = sound.clone();
        *record.pointer_mut(path).expect("a place") = value;
        of_record(&record).join("\n")
    };
    assert!(broken("/cells/0/query", json!("nearest")).contains("/cells/0/query"));
    assert!(broken("/cells/0/threads", json!("one")).contains("/cells/0/threads"));
    assert!(broken("/cells/0/build_ns/1", json!(-1)).contains("below 0"));
    assert!(broken("/machine", json!({})).contains("cpu is missing"));
    assert!(broken("/cells/0/bytes/parts", json!({ "maps": "many" })).contains("/parts/maps"));
    assert!(broken("/skipped/0", json!({ "id": "x", "reason": "y", "z": 1 })).contains("z is not known"));
}
