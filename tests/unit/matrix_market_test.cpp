#include "elements/matrix_market.hpp"

#include <butee/core/error.hpp>
#include <gtest/gtest.h>

namespace butee::test::matrix_market_test {
namespace {

using elements::read_matrix_market;

Eigen::MatrixXd dense(const std::string& text) {
  return Eigen::MatrixXd(read_matrix_market(text));
}

TEST(MatrixMarket, FillsTheOtherTriangleIn) {
  Eigen::Matrix3d expected;
  expected << 1.5, -2.0, 0.0, -2.0, 0.0, 3e-4, 0.0, 3e-4, 7.0;
  EXPECT_EQ(dense("%%MatrixMarket matrix coordinate real symmetric\n% a comment\n\n3 3 4\n"
                  "1 1 1.5\n2 1 -2\r\n 3\t2 +3e-4 \n3 3 7.0\n"),
            expected);
  EXPECT_EQ(dense("%%matrixmarket MATRIX array real symmetric\n3 3\n1.5\n-2\n0\n0\n3e-4\n7\n"), expected);
  expected << 0, -2, 0, 2, 0, 0, 0, 0, 0;
  EXPECT_EQ(dense("%%MatrixMarket matrix coordinate integer skew-symmetric\n3 3 1\n2 1 2\n"), expected);
  EXPECT_EQ(dense("%%MatrixMarket matrix array real skew-symmetric\n3 3\n2\n0\n0\n"), expected);
  expected << 0, 5, 0, 2, 0, 0, 0, 0, 0;
  EXPECT_EQ(dense("%%MatrixMarket matrix coordinate real general\n3 3 2\n1 2 5\n2 1 2\n\n% end\n"), expected);
  EXPECT_EQ(dense("%%MatrixMarket matrix array real general\n3 3\n0\n2\n0\n5\n0\n0\n0\n0\n0"), expected);
}

struct Mistake {
  std::string name, text, says;
};

class BadMatrix : public testing::TestWithParam<Mistake> {};

TEST_P(BadMatrix, IsRefusedWithItsLine) {
  try {
    read_matrix_market(GetParam().text);
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(GetParam().says)) << error.what();
  }
}

const std::string kCoordinate = "%%MatrixMarket matrix coordinate real symmetric\n";

INSTANTIATE_TEST_SUITE_P(
    texts, BadMatrix,
    testing::Values(
        Mistake{"empty", "", ":1: is not a Matrix Market file"},
        Mistake{"other_text", "1 2 3\n", ":1: is not a Matrix Market file"},
        Mistake{"vector", "%%MatrixMarket vector coordinate real general\n", ":1: is not a Matrix Market"},
        Mistake{"format", "%%MatrixMarket matrix sparse real general\n", ":1: the format must be"},
        Mistake{"complex", "%%MatrixMarket matrix coordinate complex general\n", ":1: entries must be real"},
        Mistake{"pattern", "%%MatrixMarket matrix coordinate pattern general\n", ":1: entries must be real"},
        Mistake{"hermitian", "%%MatrixMarket matrix coordinate real hermitian\n", ":1: the structure must"},
        Mistake{"no_size", kCoordinate + "% only\n", ": ends before the size"},
        Mistake{"two_sizes", kCoordinate + "3 3\n", ":2: lacks the number of entries"},
        Mistake{"not_square", kCoordinate + "3 2 1\n", ":2: the matrix must be square, not 3 x 2"},
        Mistake{"huge", kCoordinate + "999999999999 999999999999 1\n", ":2: the size must be below"},
        Mistake{"negative", kCoordinate + "3 3 -1\n", ":2: the size must be below"},
        Mistake{"short_file", kCoordinate + "3 3 2\n1 1 1.0\n", ": ends after 1 of 2 entries"},
        Mistake{"long_file", kCoordinate + "3 3 1\n1 1 1.0\n%\n2 2 1.0\n", ":5: there are more entries"},
        Mistake{"short_line", kCoordinate + "3 3 1\n1 1\n", ":3: lacks the value of entry (1, 1)"},
        Mistake{"long_line", kCoordinate + "3 3 1\n1 1 1.0 2.0\n", ":3: has more than it should: \"2.0\""},
        Mistake{"no_number", kCoordinate + "3 3 1\n1 1 1,5\n", ":3: the value of entry (1, 1): \"1,5\" is no"},
        Mistake{"no_integer", kCoordinate + "3 3 1\n1.0 1 1.5\n", ":3: the row: \"1.0\" is not an integer"},
        Mistake{"not_finite", kCoordinate + "3 3 1\n1 1 nan\n", ":3: the value of entry (1, 1) is not"},
        Mistake{"zero_based", kCoordinate + "3 3 1\n0 0 1.0\n", ":3: entry (0, 0) lies outside"},
        Mistake{"outside", kCoordinate + "3 3 1\n4 1 1.0\n", ":3: entry (4, 1) lies outside"},
        Mistake{"upper", kCoordinate + "3 3 1\n1 2 1.0\n", ":3: entry (1, 2) lies above the diagonal"},
        Mistake{"twice", kCoordinate + "3 3 3\n2 1 1.0\n1 1 1.0\n2 1 1.0\n",
                ":5: entry (2, 1) was given in line 3 before"},
        Mistake{"skew_diagonal", "%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 1\n2 2 1\n",
                ":3: entry (2, 2) lies on the diagonal"},
        Mistake{"short_array", "%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n",
                ": ends after 3 of 4 entries"}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::matrix_market_test
