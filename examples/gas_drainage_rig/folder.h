/* A folder for what a program leaves behind. */
#ifndef RIG_FOLDER_H
#define RIG_FOLDER_H

/* Makes a folder and those above it, and asks whether files may be written there. 0, or -1 with errno. */
int rig_make_folder(const char *path);

#endif
