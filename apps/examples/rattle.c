/* A beam driven by another program: a simple controller damps its middle by a force against the velocity, updated every
 * tenth of a millisecond. Prints the effect on the motion and on the stop forces. */
#include <butee.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(int status) {
  if (status == BUTEE_OK) return;
  fprintf(stderr, "%s\n", butee_message());
  exit(1);
}

/* The rms velocity of the middle over a second, m/s, and the largest force of its stop, N. */
static double rattling(double gain, double* largest) {
  butee_structure* beam = NULL;
  int64_t middle = 0;
  double sum = 0.0;
  *largest = 0.0;
  check(butee_open_file("beam.toml", "string:middle", &beam));
  check(butee_dof(beam, "string:middle", BUTEE_U, &middle));
  for (int i = 1; i <= 10000; ++i) {
    double speed = 0.0, force = 0.0;
    check(butee_motion(beam, middle, NULL, &speed, NULL));
    check(butee_set_force(beam, middle, -gain * speed));
    check(butee_advance_to(beam, 1e-4 * i));
    check(butee_contact_force(beam, middle, &force));
    sum += speed * speed;
    *largest = fmax(*largest, fabs(force));
  }
  butee_close(beam);
  return sqrt(sum / 10000.0);
}

int main(void) {
  butee_structure* none = NULL;
  double force = 0.0, force_controlled = 0.0;
  const double alone = rattling(0.0, &force), controlled = rattling(2.0e4, &force_controlled);
  printf("butee %s\n", butee_version());
  printf("speed of the middle %.4f m/s rms, with the controller %.4f m/s\n", alone, controlled);
  printf("largest force of its stop %.0f N, with the controller %.0f N\n", force, force_controlled);
  /* An error returns a status and sets a message. */
  if (butee_open_file("missing.toml", NULL, &none) != BUTEE_BAD_INPUT || none != NULL) return 1;
  printf("%s\n", butee_message());
  return force > 0.0 && controlled < 0.6 * alone ? 0 : 1;
}
