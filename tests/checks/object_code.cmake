set(frame_limit_bytes 2048)
set(depth_limit_bytes 8192)

# Bytes of code and of constants, a few percent above what the decoder takes: more is to be noticed.
set(code_limit_bytes_x86_64 139264)
set(code_limit_bytes_aarch64 110592)
set(code_limit_bytes_arm 94208)
set(code_limit_bytes_armhf 94208)
set(code_limit_bytes_s390x 192512)
set(code_limit_bytes ${code_limit_bytes_${CMAKE_SYSTEM_PROCESSOR}})
if(NOT code_limit_bytes)
    set(code_limit_bytes 192512)
endif()
set(constants_limit_bytes 4096)

# The compiler's calls of memory functions, and what the linker itself provides for position-independent code.
set(allowed_symbols memcpy memmove memset memcmp _GLOBAL_OFFSET_TABLE_)
# Not all processors of armhf can divide; the compiler's own library can.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "armhf")
    list(APPEND allowed_symbols __aeabi_idiv __aeabi_idivmod __aeabi_uidiv __aeabi_uidivmod)
endif()
# There, whoever calls provides 160 bytes in its own frame for the registers of what is called; a chain has eight
# calls.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "s390x")
    math(EXPR frame_limit_bytes "${frame_limit_bytes} + 160")
    math(EXPR depth_limit_bytes "${depth_limit_bytes} + 8 * 160")
endif()

# Calls that cannot be seen in the call graph, as caller=callee.
set(calls_through_pointers "tmi_scan_line=decode.c:try_hit")

target_compile_options(tapemark_objects PRIVATE -fcallgraph-info=su)
add_library(offender STATIC offender.c)
target_compile_options(offender PRIVATE -fcallgraph-info=su)
set_target_properties(offender PROPERTIES POSITION_INDEPENDENT_CODE ON)

add_script_test(symbols symbols.sh ${CMAKE_NM} $<TARGET_FILE:tapemark> ${allowed_symbols})
add_script_test(sections sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:tapemark>
    ${code_limit_bytes} ${constants_limit_bytes})
add_script_test(stack stack.sh ${frame_limit_bytes} ${depth_limit_bytes} "${calls_through_pointers}"
    $<TARGET_OBJECTS:tapemark_objects>)

function(add_rejection name complaint)
    add_script_test(${name} rejects.sh "${complaint}" ${SH} ${CMAKE_CURRENT_SOURCE_DIR}/${ARGN})
endfunction()

add_rejection(symbols_rejects_malloc "needs malloc" symbols.sh ${CMAKE_NM} $<TARGET_FILE:offender> ${allowed_symbols})
add_rejection(symbols_rejects_foreign_name "defines offend_"
    symbols.sh ${CMAKE_NM} $<TARGET_FILE:offender> ${allowed_symbols})
foreach(sin IN ITEMS "writable .data" "writable .bss" "bytes of code, limit 64")
    string(MAKE_C_IDENTIFIER "sections_rejects_${sin}" name)
    add_rejection(${name} "${sin}" sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:offender> 64 4096)
endforeach()
add_rejection(sections_rejects_constants "bytes of constants, limit 16"
    sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:tapemark> ${code_limit_bytes} 16)
foreach(sin "recursion through" "indirect call in" "no call through a pointer in missing"
        "dynamic frame of" "bytes in offend_by_large_frame" "bytes deep")
    string(MAKE_C_IDENTIFIER "stack_rejects_${sin}" name)
    add_rejection(${name} "${sin}" stack.sh ${frame_limit_bytes} ${depth_limit_bytes} "missing=call"
        $<TARGET_OBJECTS:offender>)
endforeach()
