#pragma once

#include <array>
#include <complex>
#include <vector>

#include "integrators/small_system.hpp"

namespace butee::integrators {

/// A linear form of the motion and its first three derivatives in time.
using Jet = std::array<double, 4>;

/// The motion of a SmallSystem while the same stops stay closed, in closed form.
///
/// The equation of motion with the closed stops falls into blocks of two coordinates y. A mode that damping leaves
/// alone is a block (q, q') with q'' + 2 d q' + omega^2 q = f; the modes that dashpots couple give complex pairs
/// z' = lambda z + f, or two real ones, from the eigenvalues of their first-order system. So
///
///     x(t + s) = R y(s) + x_harmonic(t + s) + x_parabola(s)
///
/// Blocks so slow that a parabola would be divided by next to nothing, and loads in resonance with a block, have their
/// response from rest added to y instead. Theory: piecewise.md. Checked in tests/unit/contact_state_flow_test.cpp.
class ContactStateFlow {
 public:
  /// `system` must outlive it. `closed`: of each stop. `end_time`, s: the run's, which tells slow blocks. Throws
  /// RunError where eigenvectors are too nearly parallel to be a basis.
  ContactStateFlow(const SmallSystem& system, const std::vector<bool>& closed, double end_time);

  Index size() const { return n_; }
  /// The longest piece that resonances allow, s.
  double longest() const { return longest_; }
  /// Of anything in it, 1/s.
  double largest_decay() const { return largest_decay_; }
  /// The largest rate of change, 1/s.
  double fastest() const { return fastest_; }

  /// A piece of the motion, and where in it one is.
  struct Piece {
    double t = 0.0;                          ///< s, of the start
    double displacement = 0.0, speed = 0.0;  ///< the largest at the start
    std::vector<double> start;               ///< y at the start without the responses to loads
    std::vector<double> phases;              ///< cos and sin of W t, by harmonic
    bool has_parabola = false;
    Eigen::MatrixXd parabola;     ///< n x 3: x_parabola
    bool is_short = false;        ///< the parabolas of loads have their response from rest instead, as a series
    Eigen::MatrixXd series;       ///< n x terms, in powers of s/length
    double length = 0.0;          ///< s
    std::vector<double> forcing;  ///< by block with extras: the loads' parabola in its two coordinates, 2 x 3
    double s = 0.0;               ///< s
    std::vector<double> y;        ///< as start
    std::vector<double> now;      ///< cos and sin of W (t + s)
    std::vector<double> extra;    ///< by block with extras: responses from rest and three derivatives, 2 x 4
  };

  /// Whether bounds over a longer time are larger.
  bool bounds_grow(const Piece& piece) const { return piece.has_parabola || piece.is_short || grows_; }

  /// A piece from (x, v) at t under the polynomial loads of `force`, n x 3 (ignored unless `has_force`), those of gaps
  /// included. `length`: that it goes at most, s. The piece is at its start.
  void begin(double t, const double* x, const double* v, const Eigen::MatrixXd& force, bool has_force, double length,
             Piece& piece) const;
  /// Takes the piece to t + s.
  void go(Piece& piece, double s) const;
  /// Where the piece is.
  Jet stop(const Piece& piece, Index i) const;
  Jet dof(const Piece& piece, Index i) const { return jet(dofs_, piece, i, i, -1); }
  /// Bounds of |w| and its first four derivatives from there on, over `until` s.
  std::array<double, 5> stop_bounds(const Piece& piece, Index i, double until) const;
  /// The fastest rate that shows in the velocities from there on, 1/s.
  double rate(const Piece& piece) const;
  /// The bound of the sixth derivative of a DOF from there on, over `until` s.
  double sixth_derivative(const Piece& piece, Index i, double until) const;

  /// The derivative of (x, v) at s of a piece with respect to (x, v) at its start, 2n x 2n.
  Eigen::MatrixXd propagator(double s) const;

 private:
  enum class Kind : std::uint8_t { mode, pair, reals };
  struct Block {
    Kind kind = Kind::mode;
    double decay = 0.0;             ///< d of a mode, -Re lambda of a pair
    double square = 0.0;            ///< omega^2, |lambda|^2
    double turning = 0.0;           ///< omega^2 - d^2 of a mode
    double frequency = 0.0;         ///< sqrt |turning|, Im lambda
    double rate = 0.0;              ///< omega, |lambda|, or the larger of two
    std::array<double, 2> rates{};  ///< of two real ones: lambda
    std::array<bool, 2> slow{};     ///< its parabola is in the extras; of a mode the first alone
    std::vector<Index> resonant{};  ///< harmonics that are in the extras
    Index extra = -1;               ///< its place among blocks with extras

    bool oscillates() const { return kind == Kind::pair || (kind == Kind::mode && turning > 0.1 * square); }
  };
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Linear forms of x, a row each.
  struct Rows {
    std::array<Table, 4> of;    ///< of y: the form and its derivatives, by 2 B
    Table size;                 ///< by block: by what |y| becomes the form
    Table cosine, sine, swing;  ///< by harmonic: of x_harmonic, and their root sum of squares
  };

  void add_alone(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping, Index mode);
  void add_coupled(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                   const std::vector<Index>& modes);
  void append(Block block, const LongMatrix& right, const LongMatrix& left, const LongMatrix& forcing);
  void find_extras(double end_time);
  void find_response();
  Rows rows_of(const LongMatrix& forms) const;

  void expand(const Eigen::MatrixXd& force, double length, Piece& piece) const;
  void respond(const Piece& piece, const Block& block, double s, double* extra) const;
  void respond_slowly(const Piece& piece, const Block& block, double s, double* extra) const;
  void resonate(const Piece& piece, const Block& block, double s, double* extra) const;
  Jet jet(const Rows& rows, const Piece& piece, Index row, Index a, Index b) const;
  /// The bound of derivative k in the metric of Rows::size.
  double bound_of(const Block& block, const double* y, int k, double until) const;
  double extra_bound(const Piece& piece, const Block& block, int k, double until) const;

  const SmallSystem& system_;
  Index n_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> with_extras_;
  LongMatrix right_, left_, forcing_;  ///< x = R y (n x 2B), y of (x, v) (2B x 2n), what a force adds (2B x n)
  Table project_, force_of_;
  Eigen::MatrixXd by_force_, by_x_, by_v_;  ///< M^-1, M^-1 K and M^-1 C of the contact state
  Rows dofs_, stops_;
  LongMatrix cosine_, sine_;                 ///< n x harmonics: x_harmonic
  std::array<Eigen::MatrixXd, 3> parabola_;  ///< n x n: x_parabola of F_0, and what F_1 and F_2 add to lower powers
  Table harmonic_c_, harmonic_s_;            ///< 2B x harmonics: their forcing
  double longest_, fastest_ = 0.0;
  double largest_decay_ = 0.0;
  bool grows_ = false;  ///< bounds over a longer time
  mutable std::vector<double> x_, v_;
};

}  // namespace butee::integrators
