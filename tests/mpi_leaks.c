/* With the sanitizers: what MPI takes when it starts and when it ends, and keeps until the process is gone, is no leak
   of ours.  So no stack of it has to be known by its library, for which every allocation's would have to be walked to
   its end, nor be read when a run ends. */
#include <mpi.h>
#include <sanitizer/lsan_interface.h>

int MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
  __lsan_disable();
  const int error = PMPI_Init_thread(argc, argv, required, provided);

  __lsan_enable();
  return error;
}

int MPI_Finalize(void)
{
  __lsan_disable();
  const int error = PMPI_Finalize();

  __lsan_enable();
  return error;
}
