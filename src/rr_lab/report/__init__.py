"""The blind trial as files: the record, the table of cases, the page and the summary."""
