//! All keys of the configuration, and the one that a mistyped key was probably meant to be.

use super::Config;

/// Keys of `[tracker]` in files of version 0.1, and where their values are now.
pub const FORMER: [(&str, &str); 20] = [
    ("gate_std_m", "gate.std_m"),
    ("gate_growth_m_per_s", "gate.growth_m_per_s"),
    ("gate_floor", "gate.floor"),
    ("gate_missed_share", "gate.missed_share"),
    ("gate_allotment_reach", "gate.allotment_reach"),
    ("area_length_share", "area_cue.length_share"),
    ("area_foreshortening", "area_cue.foreshortening"),
    ("area_log_std", "area_cue.log_std"),
    ("blob_fall_time_s", "blob_memory.fall_time_s"),
    ("blob_rise_time_s", "blob_memory.rise_time_s"),
    ("blob_floor", "blob_memory.floor"),
    ("blob_rest_share", "blob_memory.rest_share"),
    ("blob_rest_time_s", "blob_memory.rest_time_s"),
    ("hough_bins", "hough.bins"),
    ("hough_window", "hough.window"),
    ("hough_gamma", "hough.gamma"),
    ("hough_max_pairs", "hough.max_pairs"),
    ("hough_min_separation_px", "hough.min_separation_px"),
    ("hough_min_pixels", "hough.min_pixels"),
    ("hough_doubt_pixels", "hough.doubt_pixels"),
];

/// Every key with its sections, as `section.key`: those of the defaults and those that have none.
pub fn all() -> Vec<String> {
    let mut keys = Vec::new();
    if let Ok(toml::Value::Table(sections)) = toml::Value::try_from(complete()) {
        add_keys("", &sections, &mut keys);
    }
    keys
}

fn add_keys(prefix: &str, table: &toml::Table, keys: &mut Vec<String>) {
    for (key, value) in table {
        let full = format!("{prefix}{key}");
        if let toml::Value::Table(inner) = value {
            add_keys(&format!("{full}."), inner, keys);
        }
        keys.push(full);
    }
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
    if let Some((_, now)) = FORMER.iter().find(|(former, _)| key.strip_prefix("tracker.") == Some(former)) {
        return format!("`{key}` is now `tracker.{now}` (`sinew track arm --print-config` lists all keys)");
    }
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
