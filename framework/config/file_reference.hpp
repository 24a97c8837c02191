#pragma once

#include <cstdint>
#include <string>

#include "butee/config/value.hpp"

namespace butee::config {

/// The path of a file that a scene names: relative to the scene's own file.
BUTEE_EXPORT std::string path_beside(const Document& document, const std::string& file);

/// The whole of a regular file, of at most 2 GiB; throws InputError without its name ("cannot be read: ...").
BUTEE_EXPORT std::string read_text(const std::string& path);

/// CRC-64/XZ as 16 hexadecimal digits.
BUTEE_EXPORT std::string checksum_text(const std::string& bytes);

/// The document for a file in `folder`: the files that it names, by `file` of tables, by elements of matrices and by
/// [initial] from, are found from there, and stand with their checksums, which reading compares.
BUTEE_EXPORT Table with_files_found_from(const Document& document, const std::string& folder);

/// The document with zero in place of the files that it names, for those who need its structure alone.
BUTEE_EXPORT Document without_files(Document document);

/// What is wrong with the bytes of a file whose size and checksum are given (0 and "": are not), or "".
BUTEE_EXPORT std::string change_of(const std::string& bytes, std::int64_t size, const std::string& checksum);

}  // namespace butee::config
