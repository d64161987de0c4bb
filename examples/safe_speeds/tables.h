#ifndef SAFE_SPEEDS_TABLES_H
#define SAFE_SPEEDS_TABLES_H

#include <stdio.h>

/* A table with its head line; NULL if it cannot be written. */
FILE *open_table(const char *folder, const char *name, const char *head);

#endif
