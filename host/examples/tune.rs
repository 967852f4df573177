//! Scratch.
use sinew::config::*;
use sinew::evaluate::{clips, observed, score};
use sinew::scene::SceneOptions;
fn line(name: &str, scenes: &[observed::ObservedScene], c: &TrackerConfig) {
    let mut r = score::run_all(scenes, c).unwrap();
    let other: Vec<_> = scenes
        .iter()
        .cloned()
        .map(|mut s| {
            s.seed += 1000;
            s
        })
        .collect();
    r.extend(score::run_all(&other, c).unwrap());
    let m = score::Spread::of(&r.iter().map(|e| e.mean_m).collect::<Vec<_>>());
    let p = score::Spread::of(&r.iter().map(|e| e.mean_px).collect::<Vec<_>>());
    let mm = r.iter().map(|e| e.mean_m).sum::<f64>() / r.len() as f64;
    let pm = r.iter().map(|e| e.mean_px).sum::<f64>() / r.len() as f64;
    println!(
        "{name:34} {:.3} ({:.3}-{:.3}; {mm:.3}) m  {:.1} ({:.1}-{:.1}; {pm:.1}) px",
        m.median, m.lower, m.upper, p.median, p.lower, p.upper
    );
}
#[allow(clippy::too_many_lines, reason = "one list of trials, read from top to bottom")]
fn main() {
    rayon::ThreadPoolBuilder::new().stack_size(16 << 20).build_global().unwrap();
    let skin = sinew::skin::SkinModel::from_option(&std::env::var("SKIN").unwrap_or("gaussian".into())).unwrap();
    let mocap = std::path::Path::new("../shared/data/mocap");
    let mut list = clips::recorded(mocap).unwrap();
    list.truncate(8);
    list.extend(clips::builtin(2));
    let seeds: Vec<u64> =
        std::env::var("SEEDS").map_or(vec![1, 2], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
    let t = std::time::Instant::now();
    let scenes = observed::observe_all(&list, &seeds, &SceneOptions::default(), &Config::default(), &skin).unwrap();
    eprintln!("render {:?}", t.elapsed());
    let d = TrackerConfig::default();
    if let Ok(dump) = std::env::var("DUMP") {
        for s in &scenes {
            let r = score::summarise(&score::track(s, &d, s.seed).unwrap());
            let vis = s.truth.iter().filter(|t| t.visible).count();
            let hit = s
                .views
                .iter()
                .zip(&s.truth)
                .filter(|(v, t)| t.visible && v.candidates.iter().any(|c| c.centre.distance_px(t.hand_px) < 25.0))
                .count();
            let n = s.views.iter().map(|v| v.blobs.len()).sum::<usize>() as f64 / s.views.len() as f64;
            let az: Vec<f64> = s
                .views
                .iter()
                .zip(&s.truth)
                .filter_map(|(v, t)| {
                    v.candidates
                        .iter()
                        .filter(|c| t.visible && c.centre.distance_px(t.hand_px) < 25.0)
                        .map(|c| f64::from(c.area_px * t.hand_m.z.powi(2) / 554.26f32.powi(2)))
                        .next()
                })
                .collect();
            println!(
                "{:13} seed {} found {hit}/{vis} blobs {n:.1} area {:.4} -> {:.3} m {:.1} px",
                s.clip,
                s.seed,
                score::Spread::of(&az).median,
                r.mean_m,
                r.mean_px
            );
            if dump == format!("{}-{}", s.clip, s.seed) {
                for (f, ((e, v), t)) in
                    score::track(s, &d, s.seed).unwrap().iter().zip(&s.views).zip(&s.truth).enumerate()
                {
                    println!(
                        "{f} err {:.2} m {:.0} px vis {} face {} truth {:.0},{:.0} z {:.2} edges {} blobs {}",
                        e.error_m,
                        e.error_px,
                        t.visible as u8,
                        t.false_blob as u8,
                        t.hand_px.u_px,
                        t.hand_px.v_px,
                        t.hand_m.z,
                        v.edges.len(),
                        v.candidates
                            .iter()
                            .map(|c| format!(
                                "[{:.0},{:.0} {:.0} {:.2}]",
                                c.centre.u_px, c.centre.v_px, c.area_px, c.likelihood
                            ))
                            .collect::<String>()
                    );
                }
            }
        }
    }
    let base = toml::Value::try_from(&d).unwrap();
    line("default", &scenes, &d);
    for arg in std::env::args().skip(1) {
        let mut v = base.clone();
        for part in arg.split(',') {
            let (k, x) = part.split_once('=').unwrap();
            let x: toml::Value =
                toml::from_str::<toml::Table>(&format!("x = {}", x.replace(';', ","))).unwrap().remove("x").unwrap();
            assert!(v.as_table_mut().unwrap().insert(k.to_owned(), x).is_some(), "{k}");
        }
        let c: TrackerConfig = v.try_into().unwrap();
        line(&arg, &scenes, &c);
    }
}
