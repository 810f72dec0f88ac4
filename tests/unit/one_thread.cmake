# Read by ctest: a unit test that wants more threads asks for them (atrito_threads), as the program does for --threads.
set(ENV{OMP_NUM_THREADS} 1)
