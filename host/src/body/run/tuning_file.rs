//! `--config` of `sinew track body`: a TOML file with any of the numbers of [`BodyTuning`]; the
//! others keep their defaults.

use crate::body::tracking::BodyTuning;
use crate::error::{Context, Error, Result, bail, ensure};
use crate::file::read_text;
use std::path::Path;
use toml::{Table, Value};

/// Maximum number of steps of a solver that a file may ask for.
const MAX_SOLVER_STEPS: i64 = 100;
/// Maximum number of blocks of points that a file may ask for.
const MAX_PULLING_BLOCKS: i64 = 1_000_000;
/// Numbers that may be zero; all others have to be greater.
const MAY_BE_ZERO: [&str; 10] = [
    "root.shift_std_m",
    "root.turn_std_rad",
    "paper.root.shift_std_m",
    "paper.root.turn_std_rad",
    "self_penetration_std_m",
    "smoothing.radius_m",
    "smoothing.along_share",
    "modes.turn_rad",
    "deadband.jitter_std_errors",
    "deadband.jitter_std_m",
];

/// Keys of files of version 0.1, and their present names.
const FORMER: [(&str, &str); 5] = [
    ("pace.swing_most", "pace.max_scale_seen"),
    ("pace.unseen_most", "pace.max_scale_unseen"),
    ("steady.tremble_errors", "deadband.jitter_std_errors"),
    ("steady.tremble_m", "deadband.jitter_std_m"),
    ("draw.pays", "draw.corrects_weight"),
];

/// Reads a configuration.
///
/// # Errors
/// Names the file, and the key that is not known (with the nearest one that is) or whose value is
/// out of range.
pub fn load(path: &Path) -> Result<BodyTuning> {
    let text = read_text(path).with_context(|| {
        format!("configuration `{}` cannot be read; `sinew track body --print-config` writes one", path.display())
    })?;
    parse(&text).with_context(|| format!("configuration `{}`", path.display()))
}

/// Reads the text of a configuration.
///
/// # Errors
/// As [`load`].
pub fn parse(text: &str) -> Result<BodyTuning> {
    over_defaults(toml::from_str(text).context("it is not valid TOML")?)
}

/// Reads the same numbers as a JSON text; messages call it `name`.
///
/// # Errors
/// As [`load`].
pub fn parse_json(text: &str, name: &str) -> Result<BodyTuning> {
    let inner = || -> Result<BodyTuning> {
        let given = serde_json::from_str(text)?;
        match toml_value("", &given)? {
            Value::Table(given) => over_defaults(given),
            _ => bail!("it has to hold keys and values"),
        }
    };
    inner().with_context(|| format!("`{name}` cannot be used"))
}

/// A value of JSON; `key` is where it stands.
fn toml_value(key: &str, json: &serde_json::Value) -> Result<Value> {
    use serde_json::Value as Json;
    Ok(match json {
        Json::Bool(flag) => Value::Boolean(*flag),
        Json::String(text) => Value::String(text.clone()),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Value::Integer(whole),
            (None, Some(real)) => Value::Float(real),
            (None, None) => bail!("`{key}` has to be a number, not {number}"),
        },
        Json::Object(fields) => Value::Table(
            fields.iter().map(|(key, value)| Ok((key.clone(), toml_value(key, value)?))).collect::<Result<_>>()?,
        ),
        Json::Null | Json::Array(_) => bail!("`{key}` has to be a number, not {json}"),
    })
}

fn over_defaults(given: Table) -> Result<BodyTuning> {
    let mut all = Table::try_from(BodyTuning::default()).map_err(Error::invalid)?;
    let known = keys("", &all);
    overlay("", &mut all, given, &known)?;
    check("", &all)?;
    Ok(Value::Table(all).try_into()?)
}

/// The defaults as a file.
///
/// # Errors
/// None for the defaults that are built in.
pub fn printed() -> Result<String> {
    // Serialised at once and not as a table, which would hold doubles: 0.05 stays 0.05.
    let numbers = toml::to_string(&BodyTuning::default()).map_err(Error::invalid)?;
    Ok(format!(
        "# Defaults of `sinew track body`. Every line may be left out. Metres, radians; standard deviations grow with the root of\n\
         # time and hold after one second (docs/track_body.md).\n\n{numbers}"
    ))
}

/// All keys below `prefix`, sections too, as `section.key`.
fn keys(prefix: &str, table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    for (key, value) in table {
        let full = format!("{prefix}{key}");
        if let Value::Table(inner) = value {
            found.extend(keys(&format!("{full}."), inner));
        }
        found.push(full);
    }
    found
}

/// Puts the values of `given` in the place of those of `all`.
fn overlay(prefix: &str, all: &mut Table, given: Table, known: &[String]) -> Result<()> {
    for (key, value) in given {
        let full = format!("{prefix}{key}");
        let Some(slot) = all.get_mut(&key) else { bail!("{}", unknown(&first_key(&full, &value), known)) };
        match (slot, value) {
            (Value::Table(inner), Value::Table(given)) => overlay(&format!("{full}."), inner, given, known)?,
            (Value::Table(_), _) => bail!("`{full}` is a section; write `[{full}]`"),
            (slot @ Value::Float(_), Value::Integer(whole)) => *slot = Value::Float(whole as f64),
            (slot, value) if slot.same_type(&value) => *slot = value,
            (slot, value) => {
                bail!("`{full}` has to be of the type {}, not the {} {value}", slot.type_str(), value.type_str())
            }
        }
    }
    Ok(())
}

/// `key`, or the first one below it if its value is a section with former keys.
fn first_key(key: &str, value: &Value) -> String {
    let below = |inner: &String| format!("{key}.{inner}");
    let mut inner = value.as_table().into_iter().flat_map(Table::keys).map(below);
    inner.find(|full| FORMER.iter().any(|(former, _)| former == full)).unwrap_or_else(|| key.to_owned())
}

fn unknown(key: &str, known: &[String]) -> String {
    if let Some((_, now)) = FORMER.iter().find(|(former, _)| *former == key) {
        return format!("`{key}` is now `{now}` (`sinew track body --print-config` lists all keys)");
    }
    let nearest = known
        .iter()
        .max_by(|a, b| strsim::jaro_winkler(a, key).total_cmp(&strsim::jaro_winkler(b, key)))
        .map_or_else(String::new, |nearest| format!("the nearest one is `{nearest}` "));
    format!("there is no key `{key}`; {nearest}(`sinew track body --print-config` lists all)")
}

fn check(prefix: &str, table: &Table) -> Result<()> {
    for (key, value) in table {
        let full = format!("{prefix}{key}");
        match value {
            Value::Table(inner) => check(&format!("{full}."), inner)?,
            Value::Integer(count) => {
                let most = if key == "pulling_blocks" { MAX_PULLING_BLOCKS } else { MAX_SOLVER_STEPS };
                let least = i64::from(key != "refining_steps");
                ensure!((least..=most).contains(count), "`{full}` has to be from {least} to {most}, not {count}");
            }
            Value::Float(number) => {
                check_number(key, &full, *number).map_err(|rule| Error::Invalid(format!("`{full}` {rule}")))?;
            }
            _ => {}
        }
    }
    Ok(())
}

fn check_number(key: &str, full: &str, number: f64) -> Result<(), String> {
    let is_share = key.ends_with("persistence") || ["least_effective_share", "acceleration_share"].contains(&key);
    if is_share {
        return if (0.0..=1.0).contains(&number) {
            Ok(())
        } else {
            Err(format!("has to be from 0 to 1, not {number}"))
        };
    }
    // Inverse squares have to be ordinary numbers.
    let low = if MAY_BE_ZERO.contains(&full) { 0.0 } else { 1.0e-6 };
    // A draw is not wider than its expansion.
    let high = if full == "draw.share" { 1.0 } else { 1.0e6 };
    if (low..=high).contains(&number) { Ok(()) } else { Err(format!("has to be from {low} to {high}, not {number}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_printed_holds_the_defaults() {
        let text = printed().unwrap();
        assert_eq!(parse(&text).unwrap(), BodyTuning::default());
        assert!(text.contains("[guided.joint_std]") && text.contains("persistence = 0."), "{text}");
        assert!(!text.contains("000000"), "singles are printed as they are written: {text}");
    }

    #[test]
    fn some_numbers_replace_the_defaults_and_the_others_stay() {
        let found = parse("pulling_blocks = 12\n[guided]\nreach_std_m = 1\n[guided.joint_std]\nelbow = 3.5\n").unwrap();
        let mut wanted = BodyTuning::default();
        (wanted.pulling_blocks, wanted.guided.reach_std_m, wanted.guided.joint_std.elbow) = (12, 1.0, 3.5);
        assert_eq!(found, wanted);
        assert_eq!(parse("").unwrap(), BodyTuning::default());
        let json = r#"{"pulling_blocks": 12, "guided": {"reach_std_m": 1, "joint_std": {"elbow": 3.5}}}"#;
        assert_eq!(parse_json(json, "config").unwrap(), wanted);
        for wrong in ["[]", r#"{"guided": {"reach_std_m": null}}"#, r#"{"guided": {"reach_std_m": [1]}}"#, "x"] {
            assert!(format!("{:#}", parse_json(wrong, "config").unwrap_err()).contains("`config` cannot"), "{wrong}");
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, wanted) in [
            (
                "[guided.joint_std]\nelbwo = 1.0\n",
                "no key `guided.joint_std.elbwo`; the nearest one is `guided.joint_std.elbow`",
            ),
            ("[pace]\nswing_most = 5.0\n", "`pace.swing_most` is now `pace.max_scale_seen`"),
            ("[pace]\nunseen_most = 2.5\n", "`pace.unseen_most` is now `pace.max_scale_unseen`"),
            ("[steady]\ntremble_m = 0.01\n", "`steady.tremble_m` is now `deadband.jitter_std_m`"),
            ("[steady]\ntremble_errors = 2.0\n", "`steady.tremble_errors` is now `deadband.jitter_std_errors`"),
            ("[draw]\npays = true\n", "`draw.pays` is now `draw.corrects_weight`"),
            ("[gided]\nreach_std_m = 1.0\n", "no key `gided`; the nearest one is `guided`"),
            ("[guided]\nreach_std_m = -1.0\n", "`guided.reach_std_m` has to be from"),
            ("self_penetration_std_m = -0.01\n", "`self_penetration_std_m` has to be from 0 to"),
            ("self_penetration = 0.01\n", "the nearest one is `self_penetration_std_m`"),
            ("[guided]\nreach_std_m = nan\n", "`guided.reach_std_m` has to be from"),
            ("[root]\npersistence = 1.5\n", "`root.persistence` has to be from 0 to 1"),
            ("[angular]\nacceleration_share = 1.5\n", "`angular.acceleration_share` has to be from 0 to 1, not 1.5"),
            ("[draw]\nshare = 1.5\n", "`draw.share` has to be from 0.000001 to 1, not 1.5"),
            ("[guided]\npays = false\n", "no key `guided.pays`"),
            ("[guided]\nsolver_steps = 0\n", "`guided.solver_steps` has to be from 1"),
            ("[guided]\nsolver_steps = 2.5\n", "`guided.solver_steps` has to be of the type integer"),
            ("guided = 1\n", "`guided` is a section"),
            ("[guided\n", "not valid TOML"),
        ] {
            let found = format!("{:#}", parse(text).unwrap_err());
            assert!(found.contains(wanted), "{found} does not contain {wanted}");
        }
    }
}
