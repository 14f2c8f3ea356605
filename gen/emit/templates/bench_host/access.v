    // What the host does at the bus, in a process of its own: Verilator writes the body of a task out for each call.
    reg access_writes;
    reg [31:0] access_address, access_value;
    integer access_words;
    // They differ while an access is under way.
    reg access_asked = 1'b0, access_done = 1'b0;

    task access;
        begin
            access_asked = ~access_asked;
            wait (access_done == access_asked);
        end
    endtask

    task write_word(input [31:0] address, input [31:0] value);
        begin
            access_writes = 1'b1;
            access_address = address;
            access_value = value;
            access;
        end
    endtask

    task read_words(input [31:0] address, input integer words);
        begin
            access_writes = 1'b0;
            access_address = address;
            access_words = words;
            access;
        end
    endtask

    always begin
        wait (access_asked != access_done);
        if (access_writes)
            bus_write;
        else
            bus_read;
        access_done = access_asked;
    end

