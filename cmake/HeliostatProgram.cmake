# The command-line program: build/heliostat.

find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON QUIET IMPORTED_TARGET jansson)
if(NOT JANSSON_FOUND)
    message(FATAL_ERROR "jansson was not found: install libjansson-dev, or build without the program by "
                        "-DHELIO_BUILD_CLI=OFF.")
endif()

set(PROGRAM_SOURCES
    cli/asset.c cli/command_info.c cli/command_render.c cli/environment_source.c cli/help.c cli/help_texts.c
    cli/interrupt.c cli/machine.c cli/main.c cli/manual.c cli/message.c cli/number.c cli/option_table.c cli/options.c
    cli/progress.c cli/render_plan.c cli/stats.c cli/suggestion.c)

add_executable(heliostat_program ${PROGRAM_SOURCES})
set_target_properties(heliostat_program PROPERTIES OUTPUT_NAME heliostat
                      RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
target_compile_definitions(heliostat_program PRIVATE
    ${FEATURE_DEFINITIONS}
    HELIOSTAT_ASSET_DIR_SOURCE="${CMAKE_CURRENT_SOURCE_DIR}/assets"
    HELIOSTAT_ASSET_DIR_INSTALL="${CMAKE_INSTALL_FULL_DATADIR}/heliostat")
target_link_libraries(heliostat_program PRIVATE heliostat helio_flags PkgConfig::JANSSON m)
