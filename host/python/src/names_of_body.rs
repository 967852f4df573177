//! The options of `sinew track body` and `sinew simulate stereo` in messages, and what Python calls
//! them.

/// Longer ones are first.
pub const OF_BODY: [(&str, &str); 23] = [
    ("`sinew track body --print-config` writes one", "docs/track_body.md says what it holds"),
    (" (`sinew track body --print-config` lists all keys)", ""),
    ("(`sinew track body --print-config` lists all)", "(docs/track_body.md)"),
    ("give --threads a smaller number", "give `threads` a smaller number"),
    ("name one with --skeleton FILE.asf", "name one with `skeleton`"),
    ("take what is there with --partial", "take what is there with partial=True"),
    (" (sinew angles, simulate, track body, evaluate body)", ""),
    (
        "--skeleton, --motion-rate, --between and --heading are",
        "`skeleton`, `motion_rate_hz`, `between_s` and `heading_deg` are",
    ),
    ("(--height, --skeleton)", "(`height_m`, `measures`)"),
    ("--particles has", "`particles` has"),
    ("--threads has", "`threads` has"),
    ("--height has", "`height_m` has"),
    ("--distance has", "`distance_m` has"),
    ("--heading has", "`heading_deg` has"),
    ("--hide names", "`hide` names"),
    ("rate_hz has to be", "`rate_hz` has to be"),
    ("--body whole", "part=\"whole\""),
    ("--body upper", "part=\"upper\""),
    ("--model modes", "model=\"modes\""),
    ("--model pelvic-lift", "model=\"pelvic-lift\""),
    (" (--init)", " (`first_pose`)"),
    (" (--inside)", ""),
    ("another --out", "another folder"),
];
