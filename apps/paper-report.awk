# Writes the report from runs.csv of `butee compare apps/studies/paper.toml`. The seconds of the paper are its tables 1 to 5.

function short(x) { return sprintf("%.2g", x) }
function error(scene, method) { return err[scene, method] }
function ratio(scene, a, b) { return sec[scene, a] / sec[scene, b] }
function claim(text, verdict, number) { printf "| %s | %s | %s |\n", text, verdict, number }
function decide(condition) { return condition ? "confirmed" : "refuted" }
function largest(scene, list,   i, n, names, m) {
  n = split(list, names, " "); m = 0
  for (i = 1; i <= n; i++) if (err[scene, names[i]] > m) m = err[scene, names[i]]
  return m
}
# The quickest of those with an error below `bound`.
function quickest(scene, list, bound,   i, n, names, best) {
  n = split(list, names, " "); best = "none"
  for (i = 1; i <= n; i++)
    if (err[scene, names[i]] < bound && (best == "none" || sec[scene, names[i]] < sec[scene, best])) best = names[i]
  return best
}
function table_of(number, scene, heading, times,   i, n, names, paper) {
  printf "\n## Table %s: %s\n\n![curves](%s)\n\n", number, heading, figure[scene]
  print "| method | paper, s | ours, s | relative rms error | steps | rejected | Newton's solves | all solves |"
  print "|---|---|---|---|---|---|---|---|"
  n = split(seven, names, " "); split(times, paper, " ")
  for (i = 1; i <= n; i++)
    printf "| %s (%s) | %s | %s | %s | %d | %d | %d | %d |\n", names[i], short_name[i], paper[i], short(sec[scene, names[i]]),
           short(error(scene, names[i])), steps[scene, names[i]], rejected[scene, names[i]], newton[scene, names[i]], solves[scene, names[i]]
}

# report.md of the comparison comes first: what it says of its references.
FNR == NR {
  if (match($0, /^`[^`]*`/)) scene = substr($0, 2, RLENGTH - 2)
  if (match($0, /two computations\) is [^ ]*/)) { u = substr($0, RSTART + 21, RLENGTH - 21); sub(/\.$/, "", u); uncertainty[scene] = u }
  if (match($0, /diverge at t = [^ ]*/)) horizon[scene] = substr($0, RSTART + 15, RLENGTH - 15)
  next
}
FNR > 1 {
  gsub(/"/, "")
  err[$2, $3] = $7; sec[$2, $3] = $9; steps[$2, $3] = $10; rejected[$2, $3] = $11; newton[$2, $3] = $12; solves[$2, $3] = $14
}

END {
  seven = "rk4 rk4_fixed_factors rk4_error_scaled newmark newmark_adaptive newmark_modified newmark_modified_adaptive"
  split("RK4-1 RK4-2 RK4-3 NM1 NM2 NMM1 NMM2", short_name, " ")
  figure["oscillator"] = "figure-2a.svg"; figure["oscillator-1e-6"] = "figure-2b.svg"
  for (i = 1; i <= 4; i++) figure["beam" i] = "figure-" (i + 3) ".svg"
  o = "oscillator"; p = "oscillator-1e-6"
  print "# The paper, reproduced\n"
  print "Made by `apps/paper-report`. K. L. Nguyen et al., *Un schéma d'intégration temporelle pour la réponse transitoire de systèmes"
  print "mécaniques avec butées de contact*, CFM 2017: its five cases, its seven methods, its parameters, its law (arctan)."
  print "Errors are relative rms errors of the loaded node's displacement against `exact`, whose own uncertainty (two computations that differ by"
  printf "rounding and order) is %s on the oscillator and %s, %s, %s, %s on beam1 to beam4.\n", uncertainty[o], uncertainty["beam1"], uncertainty["beam2"], uncertainty["beam3"], uncertainty["beam4"]
  for (s in horizon) printf "%s is compared up to %s s: beyond, two such computations diverge.\n", s, horizon[s]
  print "Our seconds are single runs on one machine; the paper's are those of an interpreted program of 2017. Compare steps, solves and errors."
  table_of("1a", o, "oscillator, 1e-5 s", "8.99 15.24 5.87 8.9 12 8 22")
  table_of("1b", p, "oscillator, 1e-6 s", "1251 15.55 5.8 1400 23 1146 19")
  table_of("2", "beam1", "beam1", "1009.51 1.19 2.12 1036.11 0.61 - 0.42")
  table_of("3", "beam2", "beam2", "1036.57 1.31 1.67 1035.44 6.84 - 5.63")
  table_of("4", "beam3", "beam3", "1063.46 1.17 1.35 1031.88 12.04 - 10.31")
  table_of("5", "beam4", "beam4", "1055.51 230.53 276.73 1059.63 496.18 - 523.98")

  print "\n## The paper's claims\n\n| claim | verdict | the numbers that decide |\n|---|---|---|"
  claim("oscillator, 1e-5 s: RK4-1 is worse than NM1", decide(error(o, "rk4") > error(o, "newmark")),
        short(error(o, "rk4")) " against " short(error(o, "newmark")))
  claim("oscillator, 1e-5 s: NMM1 is bad", decide(error(o, "newmark_modified") > 0.05), short(error(o, "newmark_modified")))
  m = largest(p, "rk4 newmark newmark_modified")
  claim("oscillator, 1e-6 s: the fixed-step methods are good", decide(m < 0.01), "errors up to " short(m))
  m = largest(p, "rk4_fixed_factors rk4_error_scaled newmark_adaptive newmark_modified_adaptive")
  claim("oscillator, 1e-6 s: the adaptive methods are good", decide(m < 0.01), "errors up to " short(m))
  r = ratio(o, "newmark_modified", "newmark")
  claim("NMM1 saves only a little time against NM1", decide(r > 0.8), short(r) " of its time")
  a = ratio(o, "rk4_fixed_factors", "rk4"); b = ratio(o, "newmark_adaptive", "newmark"); c = ratio(o, "newmark_modified_adaptive", "newmark_modified")
  claim("oscillator, 1e-5 s: adaptive methods but RK4-3 are slower than fixed steps", decide(a > 1 && b > 1 && c > 1),
        "RK4-2, NM2, NMM2: " short(a) ", " short(b) ", " short(c) " times RK4-1, NM1, NMM1")
  a = error(o, "rk4_fixed_factors") / error(o, "rk4"); b = error(o, "newmark_adaptive") / error(o, "newmark")
  c = error(o, "newmark_modified_adaptive") / error(o, "newmark_modified")
  claim("oscillator, 1e-5 s: and more accurate", decide(a < 1 && b < 1 && c < 1), short(a) ", " short(b) ", " short(c) " times their errors")
  a = 1 / ratio(p, "rk4_fixed_factors", "rk4"); b = 1 / ratio(p, "newmark_adaptive", "newmark"); c = 1 / ratio(p, "newmark_modified_adaptive", "newmark_modified")
  claim("oscillator, 1e-6 s: adaptive methods are much faster", decide(a > 3 && b > 3 && c > 3), short(a) ", " short(b) ", " short(c) " times as fast")
  r = ratio(o, "newmark_modified_adaptive", "newmark_adaptive")
  claim("NMM2 is a little faster than NM2", decide(r < 1), short(r) " of its time on the oscillator")
  claim("RK4-3 wins on the oscillator", error(o, "rk4_error_scaled") < 0.01 ? "confirmed" : "refuted",
        "quickest with an error below 1 % at 1e-6 s: " quickest(p, seven, 0.01) "; RK4-3 errs by " short(error(o, "rk4_error_scaled")) " and " short(error(p, "rk4_error_scaled")))
  m = largest("beam1", seven); if (largest("beam2", seven) > m) m = largest("beam2", seven); if (largest("beam3", seven) > m) m = largest("beam3", seven)
  claim("all methods are good on beam1 to beam3", decide(m < 0.05), "errors up to " short(m))
  claim("NMM2 wins on beam1", decide(quickest("beam1", seven, 0.01) == "newmark_modified_adaptive"),
        "quickest below 1 %: " quickest("beam1", seven, 0.01) "; below 0.1 %: " quickest("beam1", seven, 0.001))
  for (i = 2; i <= 4; i++) {
    w = quickest("beam" i, seven, 0.01)
    claim("RK4-2 or RK4-3 wins on beam" i, decide(w == "rk4_fixed_factors" || w == "rk4_error_scaled"), "quickest below 1 %: " w)
  }
  claim("Newmark methods are bad on beam4", "not decidable at 1 s",
        "up to " horizon["beam4"] " s they err by " short(error("beam4", "newmark")) ", " short(error("beam4", "newmark_adaptive")) ", " short(error("beam4", "newmark_modified")) ", " short(error("beam4", "newmark_modified_adaptive")) " (NM1, NM2, NMM1, NMM2), RK4-1 to RK4-3 by " short(error("beam4", "rk4")) ", " short(error("beam4", "rk4_fixed_factors")) ", " short(error("beam4", "rk4_error_scaled")) "; beyond, two references diverge")
}
