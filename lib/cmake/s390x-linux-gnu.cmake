# A processor that has the most significant byte first, under Linux. Libraries come from Debian's s390x packages.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR s390x)

set(CMAKE_C_COMPILER s390x-linux-gnu-gcc)
# By its convention, ISO C is to evaluate float as double there, in software's oldest manner; its processors need not.
set(CMAKE_C_FLAGS_INIT -fexcess-precision=fast)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-s390x-static)
