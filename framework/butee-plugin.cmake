# butee_add_plugin(NAME source...)
#
# Builds the module NAME.so from sources that hold one BUTEE_PLUGIN(registrar), and beside it NAME.toml, the manifest of its names and
# parameters, written by the program from the module's own declaration. BUTEE_PLUGIN_OUTPUT_DIRECTORY says where (default: the
# current binary directory).
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
