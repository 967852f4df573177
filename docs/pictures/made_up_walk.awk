# A made-up walk as an angle table: `awk -v frames=1200 -v noise_deg=6 -f made_up_walk.awk > walk.csv`.
# No recording stands behind it: 60 frames a second, 13 angles of smooth functions of the position in a cycle of 66 frames, a slow change of
# pace, and noise from a generator of its own, so that every awk writes the same.
function uniform() {
    seed = (seed * 16807) % 2147483647
    return seed / 2147483647
}
function noise() { return noise_deg * pi / 180 * sqrt(-2 * log(uniform())) * cos(2 * pi * uniform()) }
function bent(phase) { return 0.1 + 0.9 * exp(2 * (cos(phase + 0.6) - 1)) }
BEGIN {
    pi = 3.14159265358979
    seed = 12345
    columns = "neck l_shoulder l_elbow l_wrist r_shoulder r_elbow r_wrist l_hip l_knee l_ankle r_hip r_knee r_ankle"
    printf "frame"
    count = split(columns, name, " ")
    for (i = 1; i <= count; i++) printf ",%s_rad", name[i]
    print ",time_s"
    for (frame = 0; frame < frames; frame++) {
        left = 2 * pi * (frame / 66 + 0.15 * sin(2 * pi * frame / 700))
        right = left + pi
        arm_l = pi / 2 + 0.35 * sin(left)
        arm_r = pi / 2 + 0.35 * sin(right)
        leg_l = pi / 2 - 0.1 - 0.45 * sin(left)
        leg_r = pi / 2 - 0.1 - 0.45 * sin(right)
        angle[1] = -pi / 2 + 0.05 + 0.02 * sin(2 * left)
        angle[2] = 1.2 + 0.2 * sin(left)
        angle[3] = arm_l
        angle[4] = arm_l - 0.35 + 0.2 * sin(left)
        angle[5] = 1.9 + 0.2 * sin(right)
        angle[6] = arm_r
        angle[7] = arm_r - 0.35 + 0.2 * sin(right)
        angle[8] = 1.3 - 0.2 * sin(left)
        angle[9] = leg_l
        angle[10] = leg_l + bent(left)
        angle[11] = 1.8 - 0.2 * sin(right)
        angle[12] = leg_r
        angle[13] = leg_r + bent(right)
        printf "%d", frame
        for (i = 1; i <= 13; i++) printf ",%.6f", angle[i] + noise()
        printf ",%.6f\n", frame / 60
    }
}
