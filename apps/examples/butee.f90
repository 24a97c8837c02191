! The Fortran 2003 interface of butee, over butee.h. Compile it with your own compiler and link with libbutee.
!
! Every function returns butee_ok or an error status; butee_message() returns the error text.
! Degrees of freedom are numbered from 0.
module butee
  use, intrinsic :: iso_c_binding
  implicit none
  private
  public :: butee_open_file, butee_open_text, butee_close, butee_size, butee_dof, butee_time, butee_advance_to, &
            butee_advance_step, butee_motion, butee_all_motion, butee_set_motion, butee_set_force, &
            butee_set_force_line, butee_contact_force, butee_quantity, butee_follow_peak, butee_peak, butee_energy, &
            butee_save, butee_restore, butee_free_snapshot, butee_message, butee_version

  integer(c_int), parameter, public :: butee_ok = 0, butee_run_failed = 1, butee_bad_input = 2, butee_bad_call = 3
  ! Displacements along x, y and z, rotations about them; u is uy, theta is rz.
  integer(c_int), parameter, public :: butee_u = 0, butee_theta = 1
  integer(c_int), parameter, public :: butee_ux = 2, butee_uy = butee_u, butee_uz = 3, butee_rx = 4, butee_ry = 5, &
                                       butee_rz = butee_theta

  interface
    function c_open_file(path, forced, made) bind(c, name="butee_open_file") result(status)
      import :: c_int, c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*), forced(*)
      type(c_ptr), intent(out) :: made
      integer(c_int) :: status
    end function
    function c_open_text(toml, forced, made) bind(c, name="butee_open_text") result(status)
      import :: c_int, c_char, c_ptr
      character(kind=c_char), intent(in) :: toml(*), forced(*)
      type(c_ptr), intent(out) :: made
      integer(c_int) :: status
    end function
    subroutine butee_close(structure) bind(c)
      import :: c_ptr
      type(c_ptr), value :: structure
    end subroutine
    function butee_size(structure, size) bind(c) result(status)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), intent(out) :: size
      integer(c_int) :: status
    end function
    function c_dof(structure, selector, kind, dof) bind(c, name="butee_dof") result(status)
      import :: c_int, c_int64_t, c_char, c_ptr
      type(c_ptr), value :: structure
      character(kind=c_char), intent(in) :: selector(*)
      integer(c_int), value :: kind
      integer(c_int64_t), intent(out) :: dof
      integer(c_int) :: status
    end function
    function butee_time(structure, t) bind(c) result(status)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: structure
      real(c_double), intent(out) :: t
      integer(c_int) :: status
    end function
    function butee_advance_to(structure, t) bind(c) result(status)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: structure
      real(c_double), value :: t
      integer(c_int) :: status
    end function
    function butee_advance_step(structure, limit, t) bind(c) result(status)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: structure
      real(c_double), value :: limit
      real(c_double), intent(out) :: t
      integer(c_int) :: status
    end function
    function butee_motion(structure, dof, u, v, a) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: dof
      real(c_double), intent(out) :: u, v, a
      integer(c_int) :: status
    end function
    function butee_all_motion(structure, size, u, v, a) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: size
      real(c_double), intent(out) :: u(size), v(size), a(size)
      integer(c_int) :: status
    end function
    function butee_set_motion(structure, size, u, v) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: size
      real(c_double), intent(in) :: u(size), v(size)
      integer(c_int) :: status
    end function
    function butee_set_force(structure, dof, force) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: dof
      real(c_double), value :: force
      integer(c_int) :: status
    end function
    function butee_set_force_line(structure, dof, from, to, until) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: dof
      real(c_double), value :: from, to, until
      integer(c_int) :: status
    end function
    function butee_contact_force(structure, dof, force) bind(c) result(status)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: structure
      integer(c_int64_t), value :: dof
      real(c_double), intent(out) :: force
      integer(c_int) :: status
    end function
    function c_quantity(structure, quantity, node, element, value) bind(c, name="butee_quantity") result(status)
      import :: c_int, c_double, c_char, c_ptr
      type(c_ptr), value :: structure
      character(kind=c_char), intent(in) :: quantity(*), node(*), element(*)
      real(c_double), intent(out) :: value
      integer(c_int) :: status
    end function
    function c_follow_peak(structure, node, quantity) bind(c, name="butee_follow_peak") result(status)
      import :: c_int, c_char, c_ptr
      type(c_ptr), value :: structure
      character(kind=c_char), intent(in) :: node(*), quantity(*)
      integer(c_int) :: status
    end function
    function c_peak(structure, node, quantity, peak) bind(c, name="butee_peak") result(status)
      import :: c_int, c_double, c_char, c_ptr
      type(c_ptr), value :: structure
      character(kind=c_char), intent(in) :: node(*), quantity(*)
      real(c_double), intent(out) :: peak
      integer(c_int) :: status
    end function
    function butee_energy(structure, kinetic, strain, contact) bind(c) result(status)
      import :: c_int, c_double, c_ptr
      type(c_ptr), value :: structure
      real(c_double), intent(out) :: kinetic, strain, contact
      integer(c_int) :: status
    end function
    function butee_save(structure, made) bind(c) result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: structure
      type(c_ptr), intent(out) :: made
      integer(c_int) :: status
    end function
    function butee_restore(structure, snapshot) bind(c) result(status)
      import :: c_int, c_ptr
      type(c_ptr), value :: structure, snapshot
      integer(c_int) :: status
    end function
    subroutine butee_free_snapshot(snapshot) bind(c)
      import :: c_ptr
      type(c_ptr), value :: snapshot
    end subroutine
    function c_message() bind(c, name="butee_message") result(text)
      import :: c_ptr
      type(c_ptr) :: text
    end function
    function c_version() bind(c, name="butee_version") result(text)
      import :: c_ptr
      type(c_ptr) :: text
    end function
    function c_strlen(text) bind(c, name="strlen") result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: text
      integer(c_size_t) :: length
    end function
  end interface

contains

  function butee_open_file(path, forced, made) result(status)
    character(*), intent(in) :: path, forced
    type(c_ptr), intent(out) :: made
    integer(c_int) :: status
    status = c_open_file(trim(path)//c_null_char, trim(forced)//c_null_char, made)
  end function

  function butee_open_text(toml, forced, made) result(status)
    character(*), intent(in) :: toml, forced
    type(c_ptr), intent(out) :: made
    integer(c_int) :: status
    status = c_open_text(trim(toml)//c_null_char, trim(forced)//c_null_char, made)
  end function

  function butee_dof(structure, selector, kind, dof) result(status)
    type(c_ptr), intent(in) :: structure
    character(*), intent(in) :: selector
    integer(c_int), intent(in) :: kind
    integer(c_int64_t), intent(out) :: dof
    integer(c_int) :: status
    status = c_dof(structure, trim(selector)//c_null_char, kind, dof)
  end function

  ! The current value of a quantity of a probe ("M", "spring_force", "u", ...); element: the beam or
  ! spring, "" if none.
  function butee_quantity(structure, quantity, node, element, value) result(status)
    type(c_ptr), intent(in) :: structure
    character(*), intent(in) :: quantity, node, element
    real(c_double), intent(out) :: value
    integer(c_int) :: status
    status = c_quantity(structure, trim(quantity)//c_null_char, trim(node)//c_null_char, trim(element)//c_null_char, value)
  end function

  ! Tracks the largest |value| of a quantity of a node over the motion; call it before the first
  ! step.
  function butee_follow_peak(structure, node, quantity) result(status)
    type(c_ptr), intent(in) :: structure
    character(*), intent(in) :: node, quantity
    integer(c_int) :: status
    status = c_follow_peak(structure, trim(node)//c_null_char, trim(quantity)//c_null_char)
  end function

  function butee_peak(structure, node, quantity, peak) result(status)
    type(c_ptr), intent(in) :: structure
    character(*), intent(in) :: node, quantity
    real(c_double), intent(out) :: peak
    integer(c_int) :: status
    status = c_peak(structure, trim(node)//c_null_char, trim(quantity)//c_null_char, peak)
  end function

  function butee_message() result(text)
    character(:), allocatable :: text
    text = to_text(c_message())
  end function

  function butee_version() result(text)
    character(:), allocatable :: text
    text = to_text(c_version())
  end function

  function to_text(from) result(text)
    type(c_ptr), intent(in) :: from
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: i
    call c_f_pointer(from, letters, [c_strlen(from)])
    allocate (character(size(letters)) :: text)
    do i = 1, size(letters)
      text(i:i) = letters(i)
    end do
  end function

end module butee
