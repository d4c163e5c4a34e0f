set(frame_limit_bytes 2048)
set(depth_limit_bytes 8192)

# The compiler's calls of memory functions, and what the linker itself provides for position-independent code.
set(allowed_symbols memcpy memmove memset memcmp _GLOBAL_OFFSET_TABLE_)

# Calls that cannot be seen in the call graph, as caller=callee.
set(calls_through_pointers "tmi_scan_line=decode.c:try_hit")

target_compile_options(tapemark_objects PRIVATE -fcallgraph-info=su)
add_library(offender STATIC offender.c)
target_compile_options(offender PRIVATE -fcallgraph-info=su)
set_target_properties(offender PROPERTIES POSITION_INDEPENDENT_CODE ON)

add_script_test(symbols symbols.sh ${CMAKE_NM} $<TARGET_FILE:tapemark> ${allowed_symbols})
add_script_test(sections sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:tapemark>)
add_script_test(stack stack.sh ${frame_limit_bytes} ${depth_limit_bytes} "${calls_through_pointers}"
    $<TARGET_OBJECTS:tapemark_objects>)

function(add_rejection name complaint)
    add_script_test(${name} rejects.sh "${complaint}" ${SH} ${CMAKE_CURRENT_SOURCE_DIR}/${ARGN})
endfunction()

add_rejection(symbols_rejects_malloc "needs malloc" symbols.sh ${CMAKE_NM} $<TARGET_FILE:offender> ${allowed_symbols})
add_rejection(symbols_rejects_foreign_name "defines offend_"
    symbols.sh ${CMAKE_NM} $<TARGET_FILE:offender> ${allowed_symbols})
add_rejection(sections_rejects_data "writable .data" sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:offender>)
add_rejection(sections_rejects_bss "writable .bss" sections.sh ${CMAKE_OBJDUMP} $<TARGET_FILE:offender>)
foreach(sin "recursion through" "indirect call in" "no call through a pointer in missing"
        "dynamic frame of" "bytes in offend_by_large_frame" "bytes deep")
    string(MAKE_C_IDENTIFIER "stack_rejects_${sin}" name)
    add_rejection(${name} "${sin}" stack.sh ${frame_limit_bytes} ${depth_limit_bytes} "missing=call"
        $<TARGET_OBJECTS:offender>)
endforeach()
