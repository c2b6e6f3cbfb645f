# What `asdic bellhop` is made of: nothing that calls HDF5, netCDF, libsndfile or FFTW.
set(quick_sources quick/main.cpp bellhop_command.cpp command.cpp console.cpp interrupt.cpp program.cpp progress_bar.cpp provenance.cpp
                  text_output.cpp)
