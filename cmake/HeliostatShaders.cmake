# SPDX-License-Identifier: MIT
# Builds the shaders to SPIR-V and makes a C file of them, so that the library needs no file at run time; adds it to
# SOURCES.

set(SHADER_FOLDER "${CMAKE_CURRENT_SOURCE_DIR}/shaders")
set(SHADER_BINARIES "${CMAKE_CURRENT_BINARY_DIR}/shaders")
file(MAKE_DIRECTORY "${SHADER_BINARIES}")
file(GLOB SHADER_INCLUDES CONFIGURE_DEPENDS "${SHADER_FOLDER}/*.glsl")
list(APPEND SHADER_INCLUDES "${SHADER_FOLDER}/layout.h" "${CMAKE_CURRENT_SOURCE_DIR}/src/sampling/rules.h")
find_program(SPIRV_VAL spirv-val) # a second look; it is a package of its own

set(SHADER_FILES "")
foreach(name ${SHADERS})
    set(binary "${SHADER_BINARIES}/${name}.spv")
    set(validation "")
    set(source "${name}")
    if(NOT name MATCHES "\\.") # other stages than compute are part of the name
        set(source "${name}.comp")
    endif()
    if(SPIRV_VAL)
        set(validation COMMAND ${SPIRV_VAL} --target-env vulkan1.2 "${binary}")
    endif()
    add_custom_command(
        OUTPUT "${binary}"
        COMMAND ${GLSLC} --target-env=vulkan1.2 -O -Werror -I "${SHADER_FOLDER}"
                -I "${CMAKE_CURRENT_SOURCE_DIR}/src" -o "${binary}"
                "${SHADER_FOLDER}/${source}"
        ${validation}
        DEPENDS "${SHADER_FOLDER}/${source}" ${SHADER_INCLUDES}
        VERBATIM)
    list(APPEND SHADER_FILES "${binary}")
endforeach()

set(SHADER_CODE "${CMAKE_CURRENT_BINARY_DIR}/shader_code.c")
string(REPLACE ";" "," SHADER_NAMES "${SHADERS}")
add_custom_command(
    OUTPUT "${SHADER_CODE}"
    COMMAND ${CMAKE_COMMAND} -DNAMES=${SHADER_NAMES} -DFOLDER=${SHADER_BINARIES} -DOUTPUT=${SHADER_CODE}
            -P "${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_shader_code.cmake"
    DEPENDS ${SHADER_FILES} cmake/write_shader_code.cmake
    VERBATIM)
list(APPEND SOURCES "${SHADER_CODE}")
