#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <butee/version.hpp>

/// The interface between butee and its modules. All of it is plain C data, so that it can be
/// compared before anything else of a module is accessed.
extern "C" {

/// Properties that must be equal in the library and the module.
struct butee_abi_tag {
  std::uint32_t size;               ///< sizeof(butee_abi_tag)
  std::uint32_t interface_version;  ///< BUTEE_INTERFACE_VERSION
  std::uint32_t eigen_version;      ///< world * 10000 + major * 100 + minor
  std::uint32_t eigen_alignment;    ///< EIGEN_MAX_ALIGN_BYTES
  std::uint32_t eigen_layout;       ///< bytes of Eigen::Index, plus 256 if matrices are stored by rows
  std::uint32_t cxx11_abi;          ///< _GLIBCXX_USE_CXX11_ABI
  std::uint32_t checked_library;    ///< 1: _GLIBCXX_DEBUG, which changes the layout of containers
  std::uint32_t sanitizers;         ///< 1: AddressSanitizer
  std::uint32_t pointer_bytes;
};
}

namespace butee::plugin {

/// The tag of the code that includes this header.
inline butee_abi_tag abi_tag() {
  butee_abi_tag tag{};
  tag.size = sizeof(butee_abi_tag);
  tag.interface_version = BUTEE_INTERFACE_VERSION;
  tag.eigen_version = EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION;
  tag.eigen_alignment = EIGEN_MAX_ALIGN_BYTES;
  tag.eigen_layout = sizeof(Eigen::Index) + (Eigen::MatrixXd::IsRowMajor ? 256 : 0);
#ifdef _GLIBCXX_USE_CXX11_ABI
  tag.cxx11_abi = _GLIBCXX_USE_CXX11_ABI;
#endif
#ifdef _GLIBCXX_DEBUG
  tag.checked_library = 1;
#endif
#ifdef __SANITIZE_ADDRESS__
  tag.sanitizers = 1;
#endif
  tag.pointer_bytes = sizeof(void*);
  return tag;
}

}  // namespace butee::plugin
