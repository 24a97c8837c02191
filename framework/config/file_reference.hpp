#pragma once

#include <cstdint>
#include <string>

#include "butee/config/value.hpp"

namespace butee::config {

/// The path of a file named in a scene, which is relative to the scene's own file.
BUTEE_EXPORT std::string path_beside(const Document& document, const std::string& file);

/// The whole content of a regular file, of at most 2 GiB; throws InputError without its name
/// ("cannot be read: ...").
BUTEE_EXPORT std::string read_text(const std::string& path);

/// CRC-64/XZ as 16 hexadecimal digits.
BUTEE_EXPORT std::string checksum_text(const std::string& bytes);

/// The document for a file in `folder`. The paths of the files that it names, by `file` of tables,
/// by elements of matrices and by [initial] from, are made relative to `folder`, and their
/// checksums are added, which are compared on reading.
BUTEE_EXPORT Table with_files_found_from(const Document& document, const std::string& folder);

/// The document with zeros in place of the files that it names, if only its structure is needed.
BUTEE_EXPORT Document without_files(Document document);

/// The difference between the bytes of a file and its recorded size and checksum (0 and "": not
/// recorded), or "".
BUTEE_EXPORT std::string change_of(const std::string& bytes, std::int64_t size, const std::string& checksum);

}  // namespace butee::config
