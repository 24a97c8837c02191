# Additional files of an installed program: manual page, completions, and the Debian package (cpack
# -G DEB).
set(desk_folder ${CMAKE_CURRENT_BINARY_DIR}/desk)
set(desk_files ${desk_folder}/butee.1 ${desk_folder}/butee.bash ${desk_folder}/_butee ${desk_folder}/butee.fish)
file(MAKE_DIRECTORY ${desk_folder})
# Completions contain the methods of the modules, so the modules must be built first.
add_custom_command(OUTPUT ${desk_files}
  COMMAND $<TARGET_FILE:butee_program> help --man > ${desk_folder}/butee.1
  COMMAND $<TARGET_FILE:butee_program> completion bash > ${desk_folder}/butee.bash
  COMMAND $<TARGET_FILE:butee_program> completion zsh > ${desk_folder}/_butee
  COMMAND $<TARGET_FILE:butee_program> completion fish > ${desk_folder}/butee.fish
  DEPENDS butee_program VERBATIM COMMENT "Manual page and shell completions")
add_custom_target(butee_desk ALL DEPENDS ${desk_files})
function(butee_desk_after_modules)
  get_property(modules DIRECTORY ${PROJECT_SOURCE_DIR}/plugins PROPERTY BUILDSYSTEM_TARGETS)
  if(modules)
    add_dependencies(butee_desk ${modules})
  endif()
endfunction()
cmake_language(DEFER DIRECTORY ${PROJECT_SOURCE_DIR} CALL butee_desk_after_modules)

install(FILES copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${desk_folder}/butee.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${desk_folder}/butee.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME butee)
install(FILES ${desk_folder}/_butee DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${desk_folder}/butee.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME butee)
  set(CPACK_PACKAGE_VENDOR "butee")
  set(CPACK_PACKAGE_CONTACT "butee <butee@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
  set(CPACK_PACKAGE_DESCRIPTION
      "Sparse Euler-Bernoulli beams, lumped masses, springs and dashpots; elastic stops with a gap, to ground or between\ntwo bodies; time integrators that are found and loaded at run time. With the library, its headers and modules.")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
      ${CMAKE_LIBRARY_OUTPUT_DIRECTORY} ${BUTEE_PLUGIN_OUTPUT_DIRECTORY})
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "gnuplot-nox, libeigen3-dev")
  set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)
  # Packages: the program with its library; depending on it, the module study_mpi and the Python
  # package.
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME butee)
  set(CPACK_DEBIAN_UNSPECIFIED_FILE_NAME DEB-DEFAULT)
  set(CPACK_COMPONENTS_ALL Unspecified)
  set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION ${CPACK_PACKAGE_DESCRIPTION})
  find_package(MPI QUIET COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    list(APPEND CPACK_COMPONENTS_ALL mpi)
    set(CPACK_COMPONENT_MPI_DESCRIPTION "Studies by mpirun: the module study_mpi of butee.")
    set(CPACK_DEBIAN_MPI_PACKAGE_NAME butee-mpi)
    set(CPACK_DEBIAN_MPI_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "butee (= ${PROJECT_VERSION})")
  endif()
  if(BUTEE_PYTHON_FOUND)
    list(APPEND CPACK_COMPONENTS_ALL python)
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Scenes, runs, batches and structures of butee in Python, with numpy.")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-butee)
    set(CPACK_DEBIAN_PYTHON_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    math(EXPR next_minor "${BUTEE_PYTHON_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "butee (= ${PROJECT_VERSION}), python3 (>= 3.${BUTEE_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-scipy, python3-matplotlib, python3-pandas")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
        "${PROJECT_SOURCE_DIR}/framework/python/package/postinst;${PROJECT_SOURCE_DIR}/framework/python/package/prerm")
  endif()
  include(CPack)
endif()
