# butee_add_plugin(NAME source...)
#
# Builds the module NAME.so from sources that contain one BUTEE_PLUGIN(registrar), and beside it the
# manifest NAME.toml with its names and parameters, which the program writes from the module's own
# declaration. BUTEE_PLUGIN_OUTPUT_DIRECTORY sets the folder (default: the current binary
# directory).
function(butee_add_plugin name)
  set(folder ${CMAKE_CURRENT_BINARY_DIR})
  if(BUTEE_PLUGIN_OUTPUT_DIRECTORY)
    set(folder ${BUTEE_PLUGIN_OUTPUT_DIRECTORY})
  endif()
  set(target butee_plugin_${name})
  add_library(${target} MODULE ${ARGN})
  target_link_libraries(${target} PRIVATE butee::framework)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${folder}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON DEFINE_SYMBOL "")
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND $<TARGET_FILE:butee::program> plugins --write-manifest $<TARGET_FILE:${target}>
    VERBATIM COMMENT "Writing the manifest of ${name}")
  add_dependencies(${target} butee::program)
endfunction()
