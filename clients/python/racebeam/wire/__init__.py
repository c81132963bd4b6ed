"""Games on a server. The module client and those that it imports need only the standard library."""
