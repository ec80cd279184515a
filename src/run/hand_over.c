/* What `clathra` hands over to another program before MPI begins: `clathra strength` and its like to the Python
   package, a case of three axes to clathra3d.  Both are found from where this program stands, so that what was
   installed or built may be moved as a whole. */
#include "clathra/run.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Path of this program. */
static bool OwnPath(char path[PATH_MAX])
{
  const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX - 1);

  path[n > 0 ? n : 0] = '\0';
  return n > 0;
}

/* Where the Python package may be, from the folder of this program: as installed, and as built. */
static const char *const package_folders[] = {CLATHRA_PACKAGE_FOLDER, "python"};

/* What it does (__main__.py). */
static const char *const package_commands[] = {"strength", "sweep", "calibrate", "compare", "plot", "report"};

static bool IsPackageCommand(const char *word)
{
  for (size_t k = 0; k < sizeof(package_commands) / sizeof(*package_commands); k++) {
    if (!strcmp(word, package_commands[k]))
      return true;
  }
  return false;
}

static bool PackagePath(const char *own, char path[PATH_MAX])
{
  const int folder = (int)(strrchr(own, '/') - own);

  for (size_t k = 0; k < sizeof(package_folders) / sizeof(*package_folders); k++) {
    if (snprintf(path, PATH_MAX, "%.*s/%s/clathra/__main__.py", folder, own, package_folders[k]) < PATH_MAX &&
        access(path, R_OK) == 0)
      return true;
  }
  return false;
}

bool HandOverPython(int argc, char **argv)
{
  char   own[PATH_MAX], package[PATH_MAX];
  char **command;
  int    n = 0;

  if (argc < 2 || !IsPackageCommand(argv[1]))
    return false;
  if (!OwnPath(own) || !PackagePath(own, package)) {
    fprintf(stderr,
            "clathra: %s needs clathra/__main__.py of the Python package, which from the folder of the program is "
            "neither in %s nor in %s\n",
            argv[1], package_folders[0], package_folders[1]);
    return true;
  }
  command = calloc((size_t)argc + 2, sizeof(*command));
  if (!command)
    return true;
  command[n++] = (char[]){"python3"};
  command[n++] = package;
  for (int k = 1; k < argc; k++)
    command[n++] = argv[k];
  if (setenv("CLATHRA_PROGRAM", own, 1) == 0)
    execvp(command[0], command);
  fprintf(stderr, "clathra: %s needs python3 with numpy and h5py: python3 cannot be started (%s)\n", argv[1],
          strerror(errno));
  free(command);
  return true;
}

void HandOverSpace(int argc, char **argv)
{
  char path[PATH_MAX];

  if (CL_DIM != 2 || argc < 2 || argv[1][0] == '-' || CaseAxes(argv[1]) != 3 || !OwnPath(path))
    return;
  char *name = strrchr(path, '/') + 1;

  snprintf(name, (size_t)(path + PATH_MAX - name), "clathra3d");
  (void)execv(path, argv); /* where it cannot, the reader of the case says what is missing */
}
