# sinew_choose_library(RESULT): the name, of those in packaging/libraries.txt, that the C compiler's flags ask for.
#
# SINEW_LIBRARY overrides it. The flags are CMAKE_C_FLAGS and those of add_compile_options in this folder.

function(sinew_choose_library result)
    if(SINEW_LIBRARY)
        set(${result} ${SINEW_LIBRARY} PARENT_SCOPE)
        return()
    endif()
    get_directory_property(options COMPILE_OPTIONS)
    # Those that only some builds or languages have say nothing of the processor.
    list(FILTER options EXCLUDE REGEX "\\$<")
    separate_arguments(flags NATIVE_COMMAND "${CMAKE_C_COMPILER_ARG1} ${CMAKE_C_FLAGS}")
    if(CMAKE_C_COMPILER_TARGET)
        list(APPEND flags --target=${CMAKE_C_COMPILER_TARGET})
    endif()
    file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/sinew_empty.c" "")
    execute_process(
        COMMAND ${CMAKE_C_COMPILER} ${flags} ${options} -dM -E "${CMAKE_CURRENT_BINARY_DIR}/sinew_empty.c"
        OUTPUT_VARIABLE macros ERROR_VARIABLE error RESULT_VARIABLE code)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "Sinew: the C compiler does not name its macros; set SINEW_LIBRARY, see firmware_cmake.md: ${error}")
    endif()
    sinew_library_of_macros("${macros}" name)
    if(NOT name)
        message(FATAL_ERROR "Sinew has no library for these compiler flags (${flags} ${options}); "
            "set -mcpu and -mfloat-abi, or SINEW_LIBRARY to one of firmware_cmake.md")
    endif()
    set(${result} ${name} PARENT_SCOPE)
endfunction()

# The library for a compiler with these predefined macros; empty where there is none.
function(sinew_library_of_macros macros result)
    set(name "")
    if(macros MATCHES "__ARM_PCS_VFP ")
        set(floats hard)
    elseif(macros MATCHES "__SOFTFP__ ")
        set(floats soft)
    else()
        set(floats softfp)
    endif()
    if(macros MATCHES "__ARM_ARCH_8M_MAIN__ |__ARM_ARCH_8_1M_MAIN__ ")
        set(name thumbv8m.main-${floats})
    elseif(macros MATCHES "__ARM_ARCH_7EM__ ")
        set(name thumbv7em-${floats})
    elseif(macros MATCHES "__ARM_ARCH_6M__ |__ARM_ARCH_7M__ |__ARM_ARCH_8M_BASE__ ")
        # A Cortex-M3 and M23 run what a Cortex-M0 does.
        set(name thumbv6m)
    elseif(macros MATCHES "__riscv_xlen 32" AND macros MATCHES "__riscv_float_abi_soft " AND
           macros MATCHES "__riscv_compressed " AND macros MATCHES "__riscv_mul ")
        set(name riscv32imc)
    elseif(macros MATCHES "__x86_64__ " AND macros MATCHES "__linux__ ")
        set(name x86_64)
    endif()
    set(${result} "${name}" PARENT_SCOPE)
endfunction()
