#pragma once

#include <array>
#include <complex>
#include <vector>

#include "integrators/small_system.hpp"

namespace butee::integrators {

/// The value of a linear form of the motion and its first three time derivatives.
using Jet = std::array<double, 4>;

/// The motion of a SmallSystem while the same stops stay closed, in closed form.
///
/// The equation of motion with the closed stops decouples into blocks of two coordinates y. A mode
/// that damping does not couple is a block (q, q') with q'' + 2 d q' + omega^2 q = f. Modes that
/// dashpots couple give, from the eigenvalues of their first-order system, blocks of one complex
/// pair z' = lambda z + f or of two real eigenvalues. Then
///
///     x(t + s) = R y(s) + x_harmonic(t + s) + x_parabola(s)
///
/// For very slow blocks the particular parabola would be divided by a small number; for these, and
/// for loads in resonance with a block, the response from rest is added to y instead. Theory:
/// piecewise.md. Checked in tests/models/piecewise_test.cpp.
class ContactStateFlow {
 public:
  /// `system` must outlive it. `closed`: for each stop. `end_time` of the run, s, determines which
  /// blocks are slow. Throws RunError if eigenvectors are too nearly parallel to form a basis.
  ContactStateFlow(const SmallSystem& system, const std::vector<bool>& closed, double end_time);

  Index size() const { return n_; }
  /// The longest piece for which responses in resonance are accurate, s.
  double longest() const { return longest_; }
  /// The largest decay rate of any block, 1/s.
  double largest_decay() const { return largest_decay_; }
  /// The largest rate of change, 1/s.
  double fastest() const { return fastest_; }

  /// A piece of the motion between two changes, and the current position s in it.
  struct Piece {
    double t = 0.0;                          ///< start of the piece, s
    double displacement = 0.0, speed = 0.0;  ///< largest |x_i|, m, and |v_i|, m/s, at the start, with and without
                                             ///< the particular responses to loads
    std::vector<double> start;               ///< y at the start, without the particular responses to loads
    std::vector<double> phases;              ///< cos and sin of W t for each harmonic
    bool has_parabola = false;
    Eigen::MatrixXd parabola;     ///< coefficients of x_parabola, n x 3
    bool is_short = false;        ///< the response to polynomial loads is `series`, from rest, instead of `parabola`
    Eigen::MatrixXd series;       ///< n x number of terms, in powers of s/length
    double length = 0.0;          ///< s
    std::vector<double> forcing;  ///< for each block with extras: load parabolas of its two coordinates, 2 x 3
    double s = 0.0;               ///< current position from the start, s
    std::vector<double> y;        ///< y at s, as in `start`
    std::vector<double> now;      ///< cos and sin of W (t + s) for each harmonic
    std::vector<double> extra;    ///< for each block with extras: responses from rest and three derivatives, 2 x 4
  };

  /// True if bounds over a longer time may be larger.
  bool bounds_grow(const Piece& piece) const { return piece.has_parabola || piece.is_short || grows_; }

  /// Starts a piece from (x, v) at t under the polynomial loads `force` (ignored unless `has_force`):
  /// a row for each DOF, then one for each stop, whose force r_i^T f acts on both its bodies. The
  /// forces of the gaps are of the stops: a stop of 1e11 N/m pushes the two bodies apart with 1e9 N,
  /// and the difference of their effects is all that matters. `length`: upper bound of the duration,
  /// s.
  void begin(double t, const double* x, const double* v, const Eigen::MatrixXd& force, bool has_force, double length,
             Piece& piece) const;
  /// Moves the piece to t + s.
  void go(Piece& piece, double s) const;
  /// Displacement of stop i at the current position, with derivatives.
  Jet stop(const Piece& piece, Index i) const;
  Jet dof(const Piece& piece, Index i) const { return jet(dofs_, piece, i, i, -1); }
  /// Bounds of |w| and its first four derivatives over the next `until` seconds.
  std::array<double, 5> stop_bounds(const Piece& piece, Index i, double until) const;
  /// The fastest rate that contributes to the velocities from the current position on, 1/s.
  double rate(const Piece& piece) const;
  /// A bound of the sixth derivative of a DOF over the next `until` seconds.
  double sixth_derivative(const Piece& piece, Index i, double until) const;

  /// The derivative of (x, v) at s of a piece with respect to (x, v) at its start, 2n x 2n.
  Eigen::MatrixXd propagator(double s) const;

 private:
  enum class Kind : std::uint8_t { mode, pair, reals };
  struct Block {
    Kind kind = Kind::mode;
    double decay = 0.0;             ///< d of a mode, -Re lambda of a pair
    double square = 0.0;            ///< omega^2, |lambda|^2
    double turning = 0.0;           ///< omega^2 - d^2 of a mode, 1/s^2
    double frequency = 0.0;         ///< sqrt |turning|, Im lambda
    double rate = 0.0;              ///< omega, |lambda|, or the larger |lambda| of two real ones
    std::array<double, 2> rates{};  ///< lambda of two real eigenvalues
    std::array<bool, 2> slow{};  ///< parabola loads are in the extras, per coordinate; a mode uses the first entry only
    std::vector<Index> resonant{};  ///< indices of harmonics that are in the extras
    Index extra = -1;               ///< index among blocks with extras; -1: none

    bool oscillates() const { return kind == Kind::pair || (kind == Kind::mode && turning > 0.1 * square); }
  };
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Linear forms of x, one per row.
  struct Rows {
    std::array<Table, 4> of;    ///< coefficients of y in the form and its three derivatives, 2 B columns
    Table size;                 ///< per block: factor from |y| to a bound of the form
    Table cosine, sine, swing;  ///< per harmonic: coefficients of x_harmonic, and their root sum of squares
  };

  void add_alone(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping, Index mode);
  void add_coupled(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                   const std::vector<Index>& modes);
  /// The effect of forces on DOFs, and behind it that of forces of the stops.
  LongMatrix with_stops(const LongMatrix& by_force) const;
  void append(Block block, const LongMatrix& right, const LongMatrix& left, const LongMatrix& forcing);
  void find_extras(double end_time);
  void find_response();
  Rows rows_of(const LongMatrix& forms) const;

  void expand(const Eigen::MatrixXd& force, double length, Piece& piece) const;
  void respond(const Piece& piece, const Block& block, double s, double* extra) const;
  void respond_slowly(const Piece& piece, const Block& block, double s, double* extra) const;
  void resonate(const Piece& piece, const Block& block, double s, double* extra) const;
  Jet jet(const Rows& rows, const Piece& piece, Index row, Index a, Index b) const;
  /// Bound of derivative k in the metric of Rows::size.
  double bound_of(const Block& block, const double* y, int k, double until) const;
  double extra_bound(const Piece& piece, const Block& block, int k, double until) const;

  const SmallSystem& system_;
  Index n_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> with_extras_;
  LongMatrix forms_;                   ///< w of the stops, m x n
  LongMatrix right_, left_, forcing_;  ///< x = R y (n x 2B); y from (x, v) (2B x 2n); y' by a force (2B x (n + m))
  Table project_, force_of_;
  Eigen::MatrixXd by_force_, by_x_, by_v_;  ///< M^-1 (n + m columns), M^-1 K and M^-1 C with the closed stops
  Rows dofs_, stops_;
  LongMatrix cosine_, sine_;  ///< x_harmonic, n x harmonics
  std::array<Eigen::MatrixXd, 3>
      parabola_;                   ///< n x (n + m): x_parabola from F_0, and the parts of F_1 and F_2 in lower powers
  Table harmonic_c_, harmonic_s_;  ///< harmonic forcing of the blocks, 2B x harmonics
  double longest_, fastest_ = 0.0;
  double largest_decay_ = 0.0;
  bool grows_ = false;  ///< bounds increase with time
  mutable std::vector<double> x_, v_;
};

}  // namespace butee::integrators
