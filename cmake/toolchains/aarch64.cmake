# Cross-builds for 64-bit ARM on Debian: packages of group `aarch64` in scripts/packages.txt, run by qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
# qemu-user 7.2 never ends a program whose oneTBB has two threads or more, so what is run there is pinned to one processor.
set(CMAKE_CROSSCOMPILING_EMULATOR taskset;-c;0;qemu-aarch64;-L;/usr/aarch64-linux-gnu)
