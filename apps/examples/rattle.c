/* A beam of butee that another program pushes: a controller of a few lines damps its middle by a force against the
 * velocity, set anew every millisecond. Prints what that does to the impacts. */
#include <butee.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(int status) {
  if (status == BUTEE_OK) return;
  fprintf(stderr, "%s\n", butee_message());
  exit(1);
}

/* The largest force of the stop at the middle within a second, N. */
static double largest_contact_force(double gain) {
  butee_structure* beam = NULL;
  int64_t middle = 0;
  double largest = 0.0;
  check(butee_open_file("beam.toml", "string:middle", &beam));
  check(butee_dof(beam, "string:middle", BUTEE_U, &middle));
  for (int i = 1; i <= 1000; ++i) {
    double speed = 0.0, force = 0.0;
    check(butee_motion(beam, middle, NULL, &speed, NULL));
    check(butee_set_force(beam, middle, -gain * speed));
    check(butee_advance_to(beam, 1e-3 * i));
    check(butee_contact_force(beam, middle, &force));
    largest = fmax(largest, fabs(force));
  }
  butee_close(beam);
  return largest;
}

int main(void) {
  butee_structure* none = NULL;
  const double free_running = largest_contact_force(0.0), controlled = largest_contact_force(500.0);
  printf("butee %s\n", butee_version());
  printf("largest force of the stop: %.0f N, with the controller %.0f N\n", free_running, controlled);
  /* A mistake is a status and a message. */
  if (butee_open_file("missing.toml", NULL, &none) != BUTEE_BAD_INPUT || none != NULL) return 1;
  printf("%s\n", butee_message());
  return controlled < free_running ? 0 : 1;
}
