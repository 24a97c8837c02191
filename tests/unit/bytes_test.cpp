#include <butee/core/bytes.hpp>
#include <butee/core/error.hpp>
#include <gtest/gtest.h>

namespace butee::test::bytes_test {
namespace {

TEST(Bytes, ComeBackAsTheyWent) {
  std::vector<std::byte> bytes;
  ByteWriter writer(bytes);
  const Vector vector = Vector::LinSpaced(5, -0.1, 1e300);
  writer.put(-0.0);
  writer.put(std::int64_t{-7});
  writer.put(true);
  writer.put(vector);
  writer.put(Vector());
  writer.put(std::string("stop"));
  ByteReader reader(bytes);
  EXPECT_TRUE(std::signbit(reader.take<double>()));
  EXPECT_EQ(reader.take<std::int64_t>(), -7);
  EXPECT_TRUE(reader.take<bool>());
  Vector read, empty;
  reader.take(read);
  reader.take(empty);
  std::string text;
  reader.take(text);
  EXPECT_TRUE(read == vector);
  EXPECT_EQ(empty.size(), 0);
  EXPECT_EQ(text, "stop");
  EXPECT_TRUE(reader.at_end());
}

/// A length that exceeds the remaining bytes is refused before allocation.
TEST(Bytes, ThatEndEarlyAreRefused) {
  std::vector<std::byte> bytes;
  ByteWriter writer(bytes);
  writer.put(~std::uint64_t{0} / 8);
  Vector vector;
  EXPECT_THROW(ByteReader(bytes).take(vector), RunError);
  std::string text;
  EXPECT_THROW(ByteReader(bytes).take(text), RunError);
  EXPECT_THROW(ByteReader({}).take<double>(), RunError);
}

/// The check value of CRC-64/XZ in the catalogue of parametrised CRC algorithms.
TEST(Bytes, ChecksumIsTheOneItSays) {
  const std::string text = "123456789";
  EXPECT_EQ(checksum(std::as_bytes(std::span(text))), 0x995DC9BBDF1939FAU);
}

}  // namespace
}  // namespace butee::test::bytes_test
