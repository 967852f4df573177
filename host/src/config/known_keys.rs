//! All keys of the configuration, and the one that a mistyped key was probably meant to be.

use super::Config;

/// Every key with its section, as `section.key`: those of the defaults and those that have none.
pub fn all() -> Vec<String> {
    let mut keys = Vec::new();
    let complete = toml::Value::try_from(complete()).ok();
    let sections = complete.as_ref().and_then(toml::Value::as_table).into_iter().flatten();
    for (section, table) in sections {
        keys.push(section.clone());
        let inner = table.as_table().into_iter().flatten();
        keys.extend(inner.map(|(key, _)| format!("{section}.{key}")));
    }
    keys
}

/// A configuration in which every optional value is set, so that serialising it shows all keys.
fn complete() -> Config {
    let mut config = Config::default();
    config.camera.set_all();
    config.body.set_all();
    config
}

/// What is said of an unknown `key`.
pub fn unknown_key_message(key: &str) -> String {
    let depth = key.matches('.').count();
    let nearest = all()
        .into_iter()
        .filter(|known| known.matches('.').count() == depth)
        .max_by(|a, b| strsim::jaro_winkler(a, key).total_cmp(&strsim::jaro_winkler(b, key)));
    match nearest {
        Some(nearest) => format!(
            "there is no key `{key}`; the nearest one is `{nearest}` (`sinew track arm --print-config` lists all)"
        ),
        None => format!("there is no key `{key}` (`sinew track arm --print-config` lists all)"),
    }
}
