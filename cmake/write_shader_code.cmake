# SPDX-License-Identifier: MIT
# Writes the SPIR-V of all shaders as arrays in C. NAMES, separated by commas; FOLDER of their .spv; OUTPUT.

string(REPLACE "," ";" NAMES "${NAMES}")
set(arrays "")
set(table "")
foreach(name ${NAMES})
    file(READ "${FOLDER}/${name}.spv" words HEX)
    string(REGEX REPLACE "(................................................................)" "\\1\n" words "${words}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])([0-9a-f][0-9a-f])([0-9a-f][0-9a-f])([0-9a-f][0-9a-f])" "0x\\4\\3\\2\\1u," words "${words}")
    string(MAKE_C_IDENTIFIER "${name}" array)
    string(APPEND arrays "static const uint32_t ${array}[] = {\n${words}};\n\n")
    string(APPEND table "    {\"${name}\", ${array}, sizeof ${array}},\n")
endforeach()
list(LENGTH NAMES count)
file(WRITE "${OUTPUT}" "/* Made of the shaders by cmake/write_shader_code.cmake. */\n#include \"vulkan/shader_code.h\"\n\n"
     "${arrays}const shader_code shader_codes[] = {\n${table}};\nconst size_t shader_code_count = ${count};\n")
