// bank_one_at_a_time: The bank has one access at a time.
// bank_address_stands: Address and direction are stable until the bank is done.
// bank_address_in_time: Address and direction are stable one cycle before the access.
    // The bank: an answer to each access, at once or a few cycles later.
    reg f_busy = 0;
    reg [10:0] f_address = 0;
    reg f_write = 0;
    reg [2:0] f_wait = 0;
    reg [10:0] p_address = 0;
    reg p_write = 0;
    reg f_past = 0;
    always @* begin
        assume (!reset);
        if (!f_busy) assume (!done && !take_byte);
        if (f_wait == 3) assume (done);
        // Only configuration words pass.
        if (word_address[10:7] != 2 || word_address[2]) assume (!take_byte);
    end
    always @(posedge clock) begin
        f_past <= 1;
        f_busy <= access | (f_busy & !done);
        f_wait <= (f_busy && !done) ? f_wait + 1 : 0;
        p_address <= word_address;
        p_write <= write;
        if (access) begin
            f_address <= word_address;
            f_write <= write;
        end
    end
    always @* begin
        bank_one_at_a_time: assert (!(access && f_busy));
        if (f_busy) begin
            bank_address_stands: assert (word_address == f_address && write == f_write);
        end
        if (access && f_past) begin
            bank_address_in_time: assert (word_address == p_address && write == p_write);
        end
        f_bound: assert (f_wait <= 3);
    end
