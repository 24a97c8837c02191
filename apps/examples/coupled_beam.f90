! A beam that strikes its stops, coupled at its middle to an absorber that this program integrates: a mass on a spring
! and a dashpot.
!
! In each time window both sides are solved alternately until the force between them converges. The last lines of the
! output compare the result with a scene that contains the absorber as elements.
program coupled_beam
  use, intrinsic :: iso_c_binding
  use butee
  implicit none
  integer, parameter :: dp = c_double
  real(dp), parameter :: mass = 40.0_dp, stiffness = 4.0e4_dp, damping = 200.0_dp, window = 5.0e-5_dp, end_time = 0.2_dp
  integer, parameter :: windows = nint(end_time/window), most_turns = 30
  type(c_ptr) :: beam, whole, snapshot
  integer(c_int64_t) :: middle, middle_of_whole, absorber
  real(dp) :: y, w, y_new, w_new, u, v, a, u_new, v_new, force, force_new, guess, t, difference, peak, expected, largest, link
  integer :: i, turn, turns

  call check(butee_open_file("beam.toml", "string:middle", beam))
  call check(butee_open_file("beam-with-absorber.toml", "", whole))
  call check(butee_dof(beam, "string:middle", butee_u, middle))
  call check(butee_dof(whole, "string:middle", butee_u, middle_of_whole))
  call check(butee_dof(whole, "absorber", butee_u, absorber))
  call check(butee_follow_peak(whole, "string:middle", "u"))

  y = 0.0_dp; w = 0.0_dp; force = 0.0_dp; turns = 0; difference = 0.0_dp; peak = 0.0_dp
  do i = 1, windows
    t = i*window
    call check(butee_motion(beam, middle, u, v, a))
    call check(butee_save(beam, snapshot))
    force_new = force
    do turn = 1, most_turns
      guess = force_new
      call check(butee_set_force_line(beam, middle, force, guess, t))
      call check(butee_advance_to(beam, t))
      call check(butee_motion(beam, middle, u_new, v_new, a))
      call absorb(u, v, u_new, v_new)
      force_new = stiffness*(y_new - u_new) + damping*(w_new - v_new)
      turns = turns + 1
      if (abs(force_new - guess) <= 1.0e-10_dp*(1.0_dp + abs(force_new))) exit
      call check(butee_restore(beam, snapshot))
    end do
    if (turn > most_turns) stop "the windows are too long: the two sides do not agree"
    call butee_free_snapshot(snapshot)
    y = y_new; w = w_new; force = force_new

    call check(butee_advance_to(whole, t))
    call check(butee_motion(whole, middle_of_whole, expected, v, a))
    difference = max(difference, abs(expected - u_new))
    peak = max(peak, abs(expected))
  end do
  call check(butee_peak(whole, "string:middle", "u", largest))
  call check(butee_quantity(whole, "spring_force", "absorber", "", link))
  call check(butee_motion(whole, absorber, expected, v, a))
  print '(a, f8.4, a, f8.4, a)', "absorber at the end: ", 1.0e3_dp*y, " mm; as one model ", 1.0e3_dp*expected, " mm"
  print '(a, es8.1, a, f5.2, a)', "largest difference of the beam: ", difference/peak, " of its peak, ", &
    real(turns, dp)/windows, " turns a window"
  print '(a, f8.4, a, f8.2, a, f8.2, a)', "largest displacement of the beam: ", 1.0e3_dp*largest, &
    " mm; force on the absorber: ", -force, " N; as one model ", link, " N"
  call butee_close(beam)
  call butee_close(whole)
  if (difference > 1.0e-3_dp*peak) stop 1
  ! Between two windows the beam exceeds its displacements at the window ends only slightly.
  if (largest < peak .or. largest > 1.001_dp*peak) stop 2
  if (abs(link + force) > 1.0e-2_dp*abs(force)) stop 3

contains

  ! Integrates the absorber over a window by the trapezoidal rule, with the beam's motion at both
  ! ends.
  subroutine absorb(u0, v0, u1, v1)
    real(dp), intent(in) :: u0, v0, u1, v1
    real(dp) :: f0
    f0 = stiffness*(u0 - y) + damping*(v0 - w)
    w_new = (mass*w + 0.5_dp*window*(f0 + stiffness*(u1 - y - 0.5_dp*window*w) + damping*v1))/ &
            (mass + 0.5_dp*window*damping + 0.25_dp*window**2*stiffness)
    y_new = y + 0.5_dp*window*(w + w_new)
  end subroutine

  subroutine check(status)
    integer(c_int), intent(in) :: status
    if (status == butee_ok) return
    print '(a)', butee_message()
    stop 1
  end subroutine

end program coupled_beam
