"""Published scores, how they were made, and whether others agree with them."""
